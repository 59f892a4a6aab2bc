#!/usr/bin/env python3
"""The numbers of flip_test.cpp, from the formulas of the papers as they stand: filters of two dimensions, in double
precision, nothing separated, nothing left out."""

from math import ceil, exp, log2, pi, sqrt

PPD = 67.0
M = [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
WHITE = [sum(row) for row in M]


def inverse(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return [[(e * i - f * h) / det, (c * h - b * i) / det, (b * f - c * e) / det],
            [(f * g - d * i) / det, (a * i - c * g) / det, (c * d - a * f) / det],
            [(d * h - e * g) / det, (b * g - a * h) / det, (a * e - b * d) / det]]


def times(m, v):
    return [sum(m[i][j] * v[j] for j in range(3)) for i in range(3)]


def ycxcz(rgb):
    x, y, z = (v / w for v, w in zip(times(M, rgb), WHITE))
    return [116 * y - 16, 500 * (x - y), 200 * (y - z)]


def rgb_of(ycc):
    y = (ycc[0] + 16) / 116
    xyz = [y + ycc[1] / 500, y, y - ycc[2] / 200]
    return times(inverse(M), [v * w for v, w in zip(xyz, WHITE)])


def hunt_lab(rgb):
    def f(t):
        d = 6 / 29
        return t ** (1 / 3) if t > d ** 3 else t / (3 * d * d) + 4 / 29
    x, y, z = (f(v / w) for v, w in zip(times(M, rgb), WHITE))
    light = 116 * y - 16
    return [light, 0.01 * light * 500 * (x - y), 0.01 * light * 200 * (y - z)]


def hyab(a, b):
    return abs(a[0] - b[0]) + sqrt((a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


MOST = hyab(hunt_lab([0, 1, 0]), hunt_lab([0, 0, 1])) ** 0.7


def redistributed(d):
    d = d ** 0.7
    knee = 0.4 * MOST
    return 0.95 / knee * d if d < knee else 0.95 + (d - knee) / (MOST - knee) * 0.05


CSF = [[(1, 0.0047), (0, 1e-5)], [(1, 0.0053), (0, 1e-5)], [(34.1, 0.04), (13.5, 0.025)]]
RADIUS = ceil(3 * sqrt(0.04 / (2 * pi * pi)) * PPD)


def csf_filter(terms):
    g = {}
    for y in range(-RADIUS, RADIUS + 1):
        for x in range(-RADIUS, RADIUS + 1):
            r2 = (x * x + y * y) / PPD ** 2
            g[x, y] = sum(a * sqrt(pi / b) * exp(-pi * pi * r2 / b) for a, b in terms)
    total = sum(g.values())
    return {k: v / total for k, v in g.items()}


def feature_filters():
    s = 0.5 * 0.082 * PPD
    r = ceil(3 * s)
    edge, point = {}, {}
    for y in range(-r, r + 1):
        for x in range(-r, r + 1):
            g = exp(-(x * x + y * y) / (2 * s * s))
            edge[x, y], point[x, y] = -x * g, (x * x / (s * s) - 1) * g
    for f in (edge, point):
        up, down = sum(v for v in f.values() if v > 0), -sum(v for v in f.values() if v < 0)
        for k, v in f.items():
            f[k] = v / (up if v > 0 else down)
    return edge, point


def convolved(image, w, h, f, x, y, transposed=False):
    total = 0.0
    for (i, j), v in f.items():
        if transposed:
            i, j = j, i
        total += v * image[min(max(y + j, 0), h - 1)][min(max(x + i, 0), w - 1)]
    return total


def flip_map(test, reference, w, h):
    csf, (edge, point) = [csf_filter(t) for t in CSF], feature_filters()
    out = []
    sides = []
    for image in (test, reference):
        ycc = [[ycxcz(p) for p in row] for row in image]
        channels = [[[p[c] for p in row] for row in ycc] for c in range(3)]
        light = [[(v + 16) / 116 for v in row] for row in channels[0]]
        side = []
        for y in range(h):
            for x in range(w):
                filtered = [convolved(channels[c], w, h, csf[c], x, y) for c in range(3)]
                lab = hunt_lab([min(max(v, 0.0), 1.0) for v in rgb_of(filtered)])
                size = [sqrt(convolved(light, w, h, f, x, y) ** 2 + convolved(light, w, h, f, x, y, True) ** 2)
                        for f in (edge, point)]
                side.append((lab, size))
        sides.append(side)
    for (lab_t, size_t), (lab_r, size_r) in zip(*sides):
        c = redistributed(hyab(lab_t, lab_r))
        f = sqrt(max(abs(size_t[i] - size_r[i]) for i in (0, 1)) / sqrt(2))
        out.append(c ** (1 - f) if c > 0 else 0.0)
    return out


def tone(x):
    return min((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 1.0)


def exposures(reference):
    light = sorted(v for row in reference for v in (times(M, p)[1] for p in row) if v > 0)
    a, b, c = 2.51 - 0.85 * 2.43, 0.03 - 0.85 * 0.59, -0.85 * 0.14
    white = (-b + sqrt(b * b - 4 * a * c)) / (2 * a)
    start, stop = log2(white / light[-1]), log2(white / light[len(light) // 2])
    n = max(2, ceil(stop - start))
    return [2 ** (start + (stop - start) * i / (n - 1)) for i in range(n)]


def mean(v):
    return sum(v) / len(v)


if __name__ == "__main__":
    print("hyab of green and blue", hyab(hunt_lab([0, 1, 0]), hunt_lab([0, 0, 1])), "most", MOST)
    print("hunt_lab(0.2, 0.5, 0.7)", hunt_lab([0.2, 0.5, 0.7]), "(0.001, 0.002, 0.003)", hunt_lab([0.001, 0.002, 0.003]))
    print("hyab", hyab([50, 3, 4], [45, 0, 0]), "redistributed 1, 10, 100",
          [redistributed(d) for d in (1, 10, 100)])
    print("ycxcz", ycxcz([0.2, 0.5, 0.7]))
    print("radius", RADIUS)
    for name, terms in zip(("luminance", "red-green", "blue-yellow"), CSF):
        f = csf_filter(terms)
        print(name, "sum", sum(f.values()), "at 0,0", f[0, 0], "1,0", f[1, 0], "3,2", f[3, 2], "6,0", f[6, 0])
    edge, point = feature_filters()
    print("edge", [edge[k] for k in ((-1, 0), (3, 2), (-9, 0))], "point", [point[k] for k in ((0, 0), (3, 2), (9, 0))])
    W, H = 21, 13
    R = [[[0.5 + 0.3 * ((x * 7 + y * 3) % 5) / 5, 0.2 + 0.03 * x, 0.1 + 0.05 * y] for x in range(W)] for y in range(H)]
    T = [[[v * (1.3 if x > 10 else 0.9) if c == 0 else v for c, v in enumerate(R[y][x])] for x in range(W)]
         for y in range(H)]
    T[4][5] = [1.0, 1.0, 1.0]
    T = [[[min(v, 1.0) for v in p] for p in row] for row in T]
    m = flip_map(T, R, W, H)
    print("map mean", mean(m), "at 0,0", m[0], "5,4", m[4 * W + 5], "11,6", m[6 * W + 11], "20,12", m[-1])
    R2 = [[[v * 4.0 ** (x / 4 - 2) for v in p] for x, p in enumerate(row)] for row in R]
    T2 = [[[v * 4.0 ** (x / 4 - 2) for v in p] for x, p in enumerate(row)] for row in T]
    e = exposures(R2)
    worst = [0.0] * (W * H)
    for f in e:
        shown = [[[[tone(f * v) for v in p] for p in row] for row in image] for image in (T2, R2)]
        worst = [max(a, b) for a, b in zip(worst, flip_map(*shown, W, H))]
    print("exposures", e, "hdr mean", mean(worst))
    black, white = [[[0.0] * 3] * 5] * 5, [[[1.0] * 3] * 5] * 5
    print("black against white", mean(flip_map(black, white, 5, 5)))
