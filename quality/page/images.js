// Images that the page holds: see quality/packed_image.h.

const float_of_half = (() => {
  const table = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, mantissa = bits & 1023;
    table[bits] = sign * (exponent ? 2 ** (exponent - 15) * (1 + mantissa / 1024) : 2 ** -14 * (mantissa / 1024));
  }
  return table;
})();

async function inflated(id) {
  const bytes = Uint8Array.from(atob(document.getElementById(id).textContent), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Radiance over data.images.unit, RGB, row 0 at the top. */
async function unpacked_rgb({ id, width, height }) {
  const bytes = await inflated(id), pixels = width * height, high = 3 * pixels;
  const planes = [new Uint16Array(pixels), new Uint16Array(pixels), new Uint16Array(pixels)];
  planes.forEach((plane, p) => {
    let before = 0;
    for (let i = 0; i < pixels; ++i) {
      const at = p * pixels + i;
      before = (before + bytes[at] + (bytes[high + at] << 8)) & 0xffff;
      plane[i] = before;
    }
  });
  const values = new Float32Array(3 * pixels), [green, red, blue] = planes;
  for (let i = 0; i < pixels; ++i) {
    values[3 * i] = float_of_half[(red[i] + green[i]) & 0xffff];
    values[3 * i + 1] = float_of_half[green[i]];
    values[3 * i + 2] = float_of_half[(blue[i] + green[i]) & 0xffff];
  }
  return { width, height, values };
}

/** Values within 0 and 1, one a pixel. */
async function unpacked_grey({ id, width, height }) {
  const bytes = await inflated(id), values = new Float32Array(width * height);
  let before = 0;
  for (let i = 0; i < values.length; ++i) {
    before = (before + bytes[i]) & 255;
    values[i] = before / 255;
  }
  return { width, height, values };
}

function cut(image, channels, [x, y, width, height]) {
  const values = new Float32Array(channels * width * height);
  for (let row = 0; row < height; ++row) {
    const from = channels * ((y + row) * image.width + x);
    values.set(image.values.subarray(from, from + channels * width), channels * row * width);
  }
  return { width, height, values };
}

/** One of the truth, or of a run: its pixels of the whole image (region -1) and of crops. */
class Source {
  constructor(name, json, run = -1) {
    this.name = name;
    this.json = json;
    this.run = run;
    this.kept = new Map();
  }

  has(region) {
    return Boolean(region < 0 ? this.json.whole : this.json.crops || this.json.whole);
  }

  has_flip(region) {
    return Boolean(this.json.flip || (region >= 0 && this.json.flip_crops));
  }

  radiance(region) {
    return this.pixels(`radiance ${region}`, region, this.json.whole, this.json.crops, 3, unpacked_rgb);
  }

  flip(region) {
    return this.pixels(`flip ${region}`, region, this.json.flip, this.json.flip_crops, 1, unpacked_grey);
  }

  /** A promise of them, made once. */
  pixels(key, region, whole, crops, channels, unpack) {
    if (!this.kept.has(key))
      this.kept.set(key, (async () => {
        if (region < 0) return unpack(whole);
        return crops ? unpack(crops[region]) : cut(await unpack(whole), channels, data.images.crops[region]);
      })());
    return this.kept.get(key);
  }
}

// Colours. All are linear until they are encoded.

const srgb_bytes = (() => {
  const table = new Uint8ClampedArray(4097);
  for (let i = 0; i <= 4096; ++i) {
    const c = i / 4096;
    table[i] = Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
  }
  return table;
})();

function srgb(linear) {
  return srgb_bytes[Math.round(4096 * Math.min(Math.max(linear, 0), 1))];
}

// As in shaders/viewer/tone_map.glsl.
const tone_maps = {
  none: (c) => c,
  reinhard: (c) => {
    const luminance = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    return c.map((value) => value / (1 + luminance));
  },
  aces: (c) => c.map((value) => {
    const x = Math.min(value, 1e4);
    return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
  }),
  agx: (c) => {
    const dot = (row, v) => row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
    const inset = [
      [0.842479062253094, 0.0784335999999992, 0.0792237451477643],
      [0.0423282422610123, 0.878468636469772, 0.0791661274605434],
      [0.0423756549057051, 0.0784336, 0.879142973793104],
    ];
    const outset = [
      [1.19687900512017, -0.0980208811401368, -0.0990297440797205],
      [-0.0528968517574562, 1.15190312990417, -0.0989611768448433],
      [-0.0529716355144438, -0.0980434501171241, 1.15107367264116],
    ];
    const least = -12.47393, most = 4.026069;
    const curve = inset.map((row) => {
      const x = (Math.min(Math.max(Math.log2(Math.max(dot(row, c), 1e-30)), least), most) - least) / (most - least);
      return (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
    });
    return outset.map((row) => Math.max(dot(row, curve), 0) ** 2.2);
  },
};

// As error_colours and flip_colours of quality/pictures.h.
const error_white = 1e-3, error_full = 1;
const flip_stops = [[0, 0, 0], [0.08, 0.006, 0.2], [0.47, 0.04, 0.19], [0.97, 0.25, 0.12], [1, 0.98, 0.9]];

/** How deep the colour of an error relative to the truth's mean is, with its sign: from -1 to 1. */
function error_depth(relative) {
  const decades = Math.log(Math.abs(relative) / error_white) / Math.log(error_full / error_white);
  return Math.sign(relative) * Math.min(Math.max(decades, 0), 1) || 0;
}

function error_colour(depth) {
  const end = depth > 0 ? [0.5, 0, 0] : [0, 0.05, 0.5];
  return end.map((value) => srgb(1 + (value - 1) * Math.abs(depth)));
}

function flip_colour(value) {
  const place = Math.min(Math.max(value, 0), 1) * (flip_stops.length - 1), stop = Math.min(Math.floor(place), flip_stops.length - 2);
  return flip_stops[stop].map((from, i) => srgb(from + (flip_stops[stop + 1][i] - from) * (place - stop)));
}
