#include "frame/looks.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/srgb.h"
#include "support/frame_probe.h"
#include "support/render.h"
#include "support/scenes.h"
#include "support/view_rays.h"

namespace airlight::frame {
namespace {

using scene::TextureWrap;
using tests::gpu_context;
using Texel = glm::u8vec4;

constexpr Texel k_black(0, 0, 0, 255), k_white(255, 255, 255, 255);

/// Images of rgba16f have 11 digits of two.
constexpr float k_half = 0x1p-11f;

/// A wall of 2 × 2 m before the eye at z = −5, whose places go from `first`, at its top left, to `last`.
scene::Geometry wall(scene::TextureImage image, glm::vec2 first, glm::vec2 last) {
  scene::Geometry geometry;
  tests::add_quad(geometry, {-1, -1, -5}, {2, 0, 0}, {0, 2, 0});
  const glm::vec2 lower_left(first.x, last.y), upper_right(last.x, first.y);
  geometry.texture_places = {{lower_left, last, upper_right}, {lower_left, upper_right, first}};
  geometry.textures.push_back(std::move(image));
  geometry.materials[0] = {.albedo = glm::vec3(1), .texture = 0};
  return geometry;
}

/// That fills the image with the wall.
scene::View view_of_wall(glm::ivec2 size) {
  scene::View view;
  view.camera.vertical_fov_degrees = glm::degrees(2 * std::atan(0.2));
  view.lights[0].position = {0.1, 0.2, 1};
  view.size = size;
  return view;
}

struct Image {
  glm::ivec2 size;
  std::vector<glm::vec4> texels;
  glm::vec3 at(int x, int y) const { return texels[static_cast<std::size_t>(y * size.x + x)]; }
};

/// An image that `Looks` draws of a frame.
Image look(const scene::Geometry& geometry, const scene::View& view, gpu::Texture LookImages::*which) {
  Image image;
  tests::look_into_frame(geometry, view, 16, [&](const FrameInputs& inputs) {
    LookImages images;
    inputs.scene.looks()->draw(inputs.scene, inputs.triangles, images);
    image = {view.size, (images.*which).read<glm::vec4>()};
  });
  return image;
}

Image base_colours(const scene::Geometry& geometry, const scene::View& view) {
  return look(geometry, view, &LookImages::base_colours);
}

Image shading_normals(const scene::Geometry& geometry, const scene::View& view) {
  return look(geometry, view, &LookImages::shading_normals);
}

glm::vec3 linear(Texel texel) {
  const auto of = [](std::uint8_t byte) { return static_cast<float>(scene::linear_from_srgb(byte / 255.0)); };
  return {of(texel.r), of(texel.g), of(texel.b)};
}

void expect_colour(glm::vec3 colour, glm::vec3 expected) {
  // llvmpipe decodes sRGB by a polynomial; a GPU may round a decoded texel to 12 bits or so.
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(colour[i], expected[i], 1e-3f);
}

const std::vector<Texel> k_four = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {188, 90, 20, 255}};

TEST(Looks, ShowsEachTexelWhereItLies) {
  scene::Geometry geometry = wall({{2, 2}, k_four}, {0, 0}, {1, 1});
  geometry.materials[0].albedo = {0.5f, 1, 0.25f};
  const Image image = base_colours(geometry, view_of_wall({14, 14}));
  // The centres of texels are those of pixels 3 and 10.
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x)
      expect_colour(image.at(3 + 7 * x, 3 + 7 * y),
                    geometry.materials[0].albedo * linear(k_four[static_cast<std::size_t>(2 * y + x)]));
}

TEST(Looks, BlendsTexelsInLinearLight) {
  // Pixel 6 of 13 is half-way between two texels.
  const Image image =
      base_colours(wall({{2, 1}, {k_black, k_white}}, {0, 0}, {1, 1}), view_of_wall({13, 13}));
  expect_colour(image.at(6, 6), glm::vec3(0.5f));
  expect_colour(image.at(5, 6), glm::vec3(0.5f - 2.0f / 13.0f));
}

TEST(Looks, GoesOnBeyondTheTexturesSidesAsItsWrapsSay) {
  const std::vector<Texel> texels = {{10, 10, 10, 255}, {80, 80, 80, 255}, {160, 160, 160, 255}, k_white};
  const auto expect_row = [&](TextureWrap wrap, std::array<int, 12> expected) {
    // Three times its width, three pixels a texel.
    scene::Geometry geometry = wall({{4, 1}, texels}, {-1, 0}, {2, 1});
    geometry.materials[0].wrap = {wrap, wrap};
    const Image row = base_colours(geometry, view_of_wall({36, 36}));
    // The same upright.
    geometry = wall({{1, 4}, texels}, {0, -1}, {1, 2});
    geometry.materials[0].wrap = {wrap, wrap};
    const Image column = base_colours(geometry, view_of_wall({36, 36}));
    for (int i = 0; i < 12; ++i) {
      const glm::vec3 colour =
          linear(texels[static_cast<std::size_t>(expected[static_cast<std::size_t>(i)])]);
      expect_colour(row.at(3 * i + 1, 7), colour);
      expect_colour(column.at(7, 3 * i + 1), colour);
    }
  };
  expect_row(TextureWrap::repeat, {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3});
  expect_row(TextureWrap::clamp, {0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3});
  expect_row(TextureWrap::mirror, {3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0});
}

/// A chessboard of single texels.
scene::TextureImage chessboard(int side) {
  scene::TextureImage image{{side, side}, {}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) image.texels.push_back((x + y) % 2 == 0 ? k_white : k_black);
  return image;
}

TEST(Looks, AveragesWhatAPixelCovers) {
  // 32 texels a pixel, and so many that they fill several rows of the store.
  const Image image = base_colours(wall(chessboard(512), {0, 0}, {1, 1}), view_of_wall({16, 16}));
  for (const glm::vec4& texel : image.texels) {
    // Levels are kept in 8 bits of sRGB: 188 is 0.5029.
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(texel[i], 0.5f, 0.004f);
  }
}

TEST(Looks, KeepsStripesAlongAFootprintApart) {
  // A floor at a grazing angle, whose stripes go away from the eye: a pixel covers many texels along them,
  // and few across.
  scene::Geometry floor;
  tests::add_quad(floor, {-50, 0, -50}, {0, 0, 100}, {100, 0, 0});
  floor.texture_places = {{{{0, 0}, {0, 1}, {1, 1}}}, {{{0, 0}, {1, 1}, {1, 0}}}};
  scene::TextureImage stripes{{512, 512}, {}};
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x) stripes.texels.push_back(x % 2 == 0 ? k_white : k_black);
  floor.textures.push_back(std::move(stripes));
  floor.materials[0] = {.albedo = glm::vec3(1), .texture = 0};
  scene::View view;
  view.camera.eye = {0, 0.25, 0};
  view.camera.target = {0, 0.0, -2};
  view.camera.vertical_fov_degrees = 10;
  view.lights[0].position = {0, 5, 0};
  view.size = {64, 64};
  const Image image = base_colours(floor, view);
  // A texel is 20 cm wide. In the middle, 2 m away, a pixel covers 5 mm across and 4.5 cm along; near the
  // top, at 8.5 m, 2.3 cm across and 77 cm along: four texels, which would leave no stripes.
  for (const int y : {32, 8}) {
    float least = 1, most = 0;
    for (int x = 0; x < 64; ++x) {
      least = std::min(least, image.at(x, y).r);
      most = std::max(most, image.at(x, y).r);
    }
    EXPECT_LT(least, 0.1f) << "row " << y;
    EXPECT_GT(most, 0.9f) << "row " << y;
  }
}

TEST(Looks, GivesEachTriangleItsOwnMaterialsTexture) {
  // A row of tiles, added from the right to the left: clusters order them anew. Each other one has no
  // texture.
  scene::Geometry geometry;
  for (int i = 7; i >= 0; --i) {
    const auto x = static_cast<float>(i);
    tests::add_quad(geometry, {0.25f * x - 1, -1, -5}, {0.25f, 0, 0}, {0, 2, 0});
    geometry.texture_places.insert(geometry.texture_places.end(), 2,
                                   {{{0.5f, 0.5f}, {0.5f, 0.5f}, {0.5f, 0.5f}}});
  }
  geometry.materials.clear();
  for (std::uint32_t tile = 0; tile < 8; ++tile) {
    scene::Material& material = geometry.materials.emplace_back();
    material.albedo = glm::vec3(0.5f);
    geometry.material_of_triangle[2 * tile] = geometry.material_of_triangle[2 * tile + 1] = tile;
    if (tile % 2 == 1) continue;
    material.texture = tile / 2;
    const auto grey = static_cast<std::uint8_t>(50 + 50 * (tile / 2));
    const int side = 1 << tile;  // 1, 4, 16, 64
    geometry.textures.push_back(
        {{side, side},
         std::vector<Texel>(static_cast<std::size_t>(side * side), Texel(grey, grey, grey, 255))});
  }
  const Image image = base_colours(geometry, view_of_wall({16, 16}));
  for (int i = 0; i < 8; ++i) {
    const int tile = 7 - i;
    const auto grey = static_cast<std::uint8_t>(50 + 50 * (tile / 2));
    expect_colour(image.at(2 * i, 8),
                  tile % 2 == 1 ? glm::vec3(0.5f) : 0.5f * linear(Texel(grey, grey, grey, 255)));
  }
}

// ---- Normals ----

/// The wall, whose normals lean out as those of a ball do.
scene::Geometry ball(float sign) {
  scene::Geometry geometry;
  tests::add_quad(geometry, {-1, -1, -5}, {2, 0, 0}, {0, 2, 0});
  const auto n = [&](float x, float y) { return sign * glm::normalize(glm::vec3(x, y, 2)); };
  geometry.normals = {{n(-1, -1), n(1, -1), n(1, 1)}, {n(-1, -1), n(1, 1), n(-1, 1)}};
  return geometry;
}

TEST(Looks, InterpolatesNormals) {
  const Image image = shading_normals(ball(1), view_of_wall({16, 16}));
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      // All four have the same length before: the interpolated one is along (x, y, 2). They are kept in 16
      // bits.
      const glm::vec3 expected = glm::normalize(
          glm::vec3((static_cast<float>(x) - 7.5f) / 8, (7.5f - static_cast<float>(y)) / 8, 2));
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(image.at(x, y)[i], expected[i], k_half + 7e-5f);
    }
}

TEST(Looks, TurnsNormalsToTheSideThatIsSeen) {
  scene::View behind = view_of_wall({16, 16});
  behind.camera.eye = {0, 0, -10};
  behind.camera.target = {0, 0, -5};
  const Image image = shading_normals(ball(1), behind);
  EXPECT_LT(image.at(8, 8).z, -0.99f);
}

TEST(Looks, ShadingIsByNormalsAndTheLitSideByTriangles) {
  const scene::Geometry geometry = ball(1);
  scene::View view = view_of_wall({16, 16});
  view.medium.sigma_s = glm::vec3(0);
  Frame frame(gpu_context(), geometry, 16);
  NoShadow no_shadow;
  NoAirlight no_airlight;
  gpu::StageTimer off(nullptr);
  const auto expect_shaded = [&](bool is_lit) {
    frame.render(view, no_shadow, no_airlight, off);
    const FrameImages images = frame.read();
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) {
        const glm::dvec3 normal = glm::normalize(glm::dvec3((x - 7.5) / 8, (7.5 - y) / 8, 2));
        const glm::dvec3 way = view.lights[0].position - glm::dvec3((x - 7.5) / 8, (7.5 - y) / 8, -5);
        const double r = glm::length(way);
        const double expected =
            is_lit ? 0.8 / std::numbers::pi * std::max(glm::dot(normal, way) / r, 0.0) / (r * r) : 0.0;
        EXPECT_NEAR(static_cast<double>(images.radiance[static_cast<std::size_t>(16 * y + x)].r), expected,
                    2 * static_cast<double>(k_half) * 0.8 / std::numbers::pi / (r * r));
      }
  };
  expect_shaded(true);
  // At the right edge normals lean by half a right angle: this light is above some of them, below others.
  view.lights[0].position = {9, 0, -4};
  expect_shaded(true);
  // Behind the wall, but above the normals of its right side.
  view.lights[0].position = {9, 0, -5.5};
  expect_shaded(false);
}

// ---- What methods compute ----

TEST(Looks, LeaveAirlightAndShadowsAsTheyAre) {
  const scene::Scene& cornell = tests::builtin("cornell");
  scene::Geometry dressed = cornell.geometry;
  dressed.textures.push_back(chessboard(64));
  dressed.texture_places.assign(dressed.triangles.size(), {{{0, 0}, {3, 0}, {0, 3}}});
  dressed.normals.assign(dressed.triangles.size(), {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
  for (scene::Material& material : dressed.materials) material.texture = 0;
  const scene::View view = tests::view_of(cornell, {64, 48});
  const tests::VsvSettings settings{.resolution = {64, 128, 128}, .shadow_map = 256, .surface_shadows = true};
  const FrameImages flat = tests::render_vsv(cornell.geometry, view, settings);
  const FrameImages textured = tests::render_vsv(dressed, view, settings);
  EXPECT_EQ(textured.airlight, flat.airlight);
  EXPECT_EQ(textured.visibility, flat.visibility);
  EXPECT_EQ(textured.distance, flat.distance);
  EXPECT_NE(textured.radiance, flat.radiance);
}

}  // namespace
}  // namespace airlight::frame
