// Textures and normals of models.
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/decode_image.h"
#include "scene/import.h"
#include "support/image_files.h"
#include "support/models.h"

namespace airlight::scene {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using tests::add_accessor, tests::add_view, tests::data_uri, tests::primitive, tests::triangle;
using tests::jpeg_file, tests::png_file;

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();

class GltfLooks : public tests::ImportFolder {
 protected:
  GltfLooks() { looks_ = Looks::textured; }
};
class ObjLooks : public GltfLooks {};

/// Of the four corners of tests::k_square, of which the triangle has the first three.
const std::vector<float> k_places = {0, 1, 1, 1, 0.25f, 0, 0, 0};

/// The triangle with a texture. @param image an element of `images`
json textured(json image) {
  json document = triangle();
  const std::size_t places = add_accessor(document, k_places, tests::k_float, "VEC2");
  primitive(document)["attributes"]["TEXCOORD_0"] = places;
  primitive(document)["material"] = 0;
  document["materials"] = {{{"name", "brick"},
                            {"pbrMetallicRoughness",
                             {{"baseColorTexture", {{"index", 0}}}, {"baseColorFactor", {0.5, 1, 1, 1}}}}}};
  document["textures"] = {{{"source", 0}}};
  document["images"] = json::array({std::move(image)});
  return document;
}

json& base_texture(json& document) {
  return document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
}

std::string four_texels() {
  return png_file({2, 2}, tests::k_four_texels);
}

const Material& material_of(const Scene& scene, std::size_t triangle) {
  return scene.geometry.materials.at(scene.geometry.material_of_triangle.at(triangle));
}

void expect_places(const Scene& scene, std::size_t triangle, std::array<glm::vec2, 3> expected) {
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(glm::distance(scene.geometry.texture_places.at(triangle)[i], expected[i]), 0.0f, 1e-6f)
        << "corner " << i;
}

void expect_normals(const Scene& scene, std::size_t triangle, std::array<glm::vec3, 3> expected) {
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(glm::distance(scene.geometry.normals.at(triangle)[i], glm::normalize(expected[i])), 0.0f,
                1e-6f)
        << "corner " << i;
}

// ---- glTF textures ----

TEST_F(GltfLooks, ReadsATextureWhereverItIs) {
  write("four texels.png", four_texels());
  json in_buffer = textured({{"mimeType", "image/png"}});
  in_buffer["images"][0]["bufferView"] = add_view(in_buffer, four_texels());
  for (const json& document : {textured({{"uri", "four%20texels.png"}}),
                               textured({{"uri", data_uri(four_texels(), "image/png")}}), in_buffer}) {
    const Scene scene = load(document);
    ASSERT_EQ(scene.geometry.textures.size(), 1u);
    EXPECT_EQ(scene.geometry.textures[0].size, glm::ivec2(2, 2));
    EXPECT_EQ(scene.geometry.textures[0].texels, tests::k_four_texels);
    EXPECT_EQ(material_of(scene, 0).texture, 0u);
    EXPECT_EQ(material_of(scene, 0).albedo, glm::vec3(0.5f, 1, 1));
    EXPECT_EQ(material_of(scene, 0).wrap, (std::array{TextureWrap::repeat, TextureWrap::repeat}));
    expect_places(scene, 0, {{{0, 1}, {1, 1}, {0.25f, 0}}});
    EXPECT_THAT(scene.report.warnings, IsEmpty());
  }
}

TEST_F(GltfLooks, ReadsAJpeg) {
  const std::string jpeg = jpeg_file({3, 1}, std::vector<glm::u8vec3>(3, glm::u8vec3(90)));
  EXPECT_EQ(load(textured({{"uri", data_uri(jpeg, "image/jpeg")}})).geometry.textures.at(0).size,
            glm::ivec2(3, 1));
}

TEST_F(GltfLooks, DecodesAnImageOnceThatSeveralTexturesHave) {
  json document = textured({{"uri", data_uri(four_texels(), "image/png")}});
  document["textures"].push_back({{"source", 0}});
  document["materials"].push_back(document["materials"][0]);
  document["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
  EXPECT_EQ(load(document).geometry.textures.size(), 1u);
}

TEST_F(GltfLooks, TakesTheSamplersWraps) {
  json document = textured({{"uri", data_uri(four_texels(), "image/png")}});
  document["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  document["textures"][0]["sampler"] = 0;
  EXPECT_EQ(material_of(load(document), 0).wrap, (std::array{TextureWrap::clamp, TextureWrap::mirror}));
  document["textures"][0]["sampler"] = 1;
  expect_error(document, "material 0 'brick': sampler 1 does not exist");
}

TEST_F(GltfLooks, TakesTexturePlacesOfAnySetAndType) {
  json document = textured({{"uri", data_uri(four_texels(), "image/png")}});
  const auto expect_of = [&](std::size_t accessor, std::array<glm::vec2, 3> expected) {
    document["accessors"][accessor]["normalized"] = true;
    primitive(document)["attributes"]["TEXCOORD_1"] = accessor;
    base_texture(document)["texCoord"] = 1;
    expect_places(load(document), 0, expected);
  };
  expect_of(
      add_accessor(document, std::vector<std::uint8_t>{0, 255, 51, 0, 255, 0, 0, 0}, tests::k_u8, "VEC2"),
      {{{0, 1}, {0.2f, 0}, {1, 0}}});
  expect_of(add_accessor(document, std::vector<std::uint16_t>{0, 65535, 13107, 0, 65535, 0, 0, 0},
                         tests::k_u16, "VEC2"),
            {{{0, 1}, {0.2f, 0}, {1, 0}}});
  document["accessors"].back()["normalized"] = false;
  expect_error(document, "texture coordinates must be pairs of floats");
}

TEST_F(GltfLooks, MovesTexturesByTheTransformExtension) {
  json document = textured({{"uri", data_uri(four_texels(), "image/png")}});
  document["extensionsUsed"] = document["extensionsRequired"] = {"KHR_texture_transform"};
  json& transform = base_texture(document)["extensions"]["KHR_texture_transform"];
  transform = {{"offset", {0.5, 0.25}}, {"scale", {2, 3}}};
  const Scene scene = load(document);
  expect_places(scene, 0, {{{0.5f, 3.25f}, {2.5f, 3.25f}, {1, 0.25f}}});
  EXPECT_THAT(scene.report.warnings, IsEmpty());
  // A quarter turn, counter-clockwise as the image is seen: what lay to the right lies above.
  transform = {{"rotation", 1.5707963267948966}};
  expect_places(load(document), 0, {{{1, 0}, {1, -1}, {0, -0.25f}}});
  // A set of its own.
  primitive(document)["attributes"]["TEXCOORD_1"] =
      add_accessor(document, std::vector<float>(8, 0.75f), tests::k_float, "VEC2");
  transform = {{"texCoord", 1}};
  expect_places(load(document), 0, {{{0.75f, 0.75f}, {0.75f, 0.75f}, {0.75f, 0.75f}}});
  for (const json& broken :
       {json{{"offset", {1}}}, json{{"scale", "x"}}, json{{"rotation", "x"}}, json{{"texCoord", 0.5}}}) {
    transform = broken;
    expect_error(document, "material 0 'brick', KHR_texture_transform: its ");
  }
}

TEST_F(GltfLooks, ShowsAPrimitiveWithoutPlacesInItsMaterialsColour) {
  json document = textured({{"uri", data_uri(four_texels(), "image/png")}});
  primitive(document)["attributes"].erase("TEXCOORD_0");
  const Scene scene = load(document);
  EXPECT_EQ(material_of(scene, 0).texture, std::nullopt);
  EXPECT_EQ(material_of(scene, 0).albedo, glm::vec3(0.5f, 1, 1));
  EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("1 triangles without texture coordinates")));
}

TEST_F(GltfLooks, ReadsWhatMasksCutOut) {
  json document = textured({{"uri", data_uri(four_texels(), "image/png")}});
  json& material = document["materials"][0];
  const auto cut_out = [&] { return material_of(load(document), 0).cut_out; };
  material["alphaCutoff"] = 0.25;
  EXPECT_FALSE(cut_out()) << "it is opaque";
  material["alphaMode"] = "MASK";
  ASSERT_TRUE(cut_out());
  EXPECT_EQ(cut_out()->texture, 0u);
  EXPECT_EQ(cut_out()->least_alpha, 0.25f);
  EXPECT_THAT(load(document).report.warnings, IsEmpty());
  material["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.5;  // multiplies the texture's alpha
  EXPECT_EQ(cut_out()->least_alpha, 0.5f);
  material.erase("alphaCutoff");
  EXPECT_EQ(cut_out()->least_alpha, 1.0f) << "a half is the default";
  material["alphaCutoff"] = 0;
  EXPECT_FALSE(cut_out());

  // Nothing of it is left.
  material["alphaCutoff"] = 0.75;
  const Scene nothing = load(document);
  EXPECT_TRUE(nothing.geometry.triangles.empty());
  EXPECT_THAT(nothing.report.warnings, Contains(HasSubstr("whose material cuts all of them away")));

  looks_ = Looks::flat;
  EXPECT_FALSE(cut_out());
  EXPECT_THAT(load(document).report.warnings, Contains(HasSubstr("alpha masks of materials ignored (1)")));
  material["alphaCutoff"] = "x";
  expect_error(document, "alphaCutoff");
}

TEST_F(GltfLooks, KeepsTrianglesWithoutPlacesWhole) {
  json document = textured({{"uri", data_uri(four_texels(), "image/png")}});
  document["materials"][0]["alphaMode"] = "MASK";
  primitive(document)["attributes"].erase("TEXCOORD_0");
  EXPECT_FALSE(material_of(load(document), 0).cut_out);
}

TEST_F(GltfLooks, RefusesTexturesThatCannotBeShownAndNamesTheirMaterial) {
  const std::string where = "material 0 'brick', texture ";
  expect_error(textured({{"uri", "none.png"}}), where + "'none.png': there is no such file");
  write("broken.png", four_texels().substr(0, 60));
  expect_error(textured({{"uri", "broken.png"}}), where + "'broken.png': it is a broken PNG");
  expect_error(textured({{"uri", "broken.png"}}), "--looks flat");
  expect_error(textured({{"uri", data_uri("no picture", "image/png")}}),
               where + "image 0: it is neither PNG nor JPEG");
  const std::vector<glm::u8vec4> row(k_largest_texture + 1);
  write("wide.png", png_file({k_largest_texture + 1, 1}, row));
  expect_error(textured({{"uri", "wide.png"}}), where + "'wide.png': its 16385x1 texels");

  json document = textured({{"uri", "none.png"}});
  base_texture(document)["index"] = 1;
  expect_error(document, "material 0 'brick': texture 1 does not exist");
  base_texture(document)["index"] = "0";
  expect_error(document, "glTF does not allow the value \"0\" here");
  document = textured({{"uri", "none.png"}});
  document["textures"][0]["source"] = 3;
  expect_error(document, "material 0 'brick': image 3 does not exist");
  document["textures"][0].erase("source");
  expect_error(document, where + "0: it names no image");

  document = textured({{"mimeType", "image/png"}});
  document["images"][0]["bufferView"] = add_view(document, four_texels());
  document["bufferViews"].back()["byteLength"] = 100000;
  expect_error(document, "it reaches to byte 100000");
  document["bufferViews"].back()["byteLength"] = 0;
  expect_error(document, where + "image 0: it is empty");
}

TEST_F(GltfLooks, RefusesPlacesThatDoNotFit) {
  json document = textured({{"uri", data_uri(four_texels(), "image/png")}});
  primitive(document)["attributes"]["TEXCOORD_0"] =
      add_accessor(document, std::vector<float>{0, 0}, tests::k_float, "VEC2");
  expect_error(document, "it has 1 TEXCOORD_0 for 4 vertices");
  for (const float bad : {k_nan, std::numeric_limits<float>::infinity(), 1e19f}) {
    primitive(document)["attributes"]["TEXCOORD_0"] =
        add_accessor(document, std::vector<float>{0, 0, 0, bad, 0, 0, 0, 0}, tests::k_float, "VEC2");
    expect_error(document, "mesh 0, primitive 0, vertex 1: the texture coordinate");
  }
}

TEST_F(GltfLooks, FlatNeitherReadsNorWantsTextures) {
  looks_ = Looks::flat;
  const Scene scene = load(textured({{"uri", "none.png"}}));
  EXPECT_THAT(scene.geometry.textures, IsEmpty());
  EXPECT_THAT(scene.geometry.texture_places, IsEmpty());
  EXPECT_EQ(material_of(scene, 0).texture, std::nullopt);
  EXPECT_THAT(scene.report.warnings, Contains("textures ignored (1): surfaces have one colour"));
}

TEST_F(GltfLooks, CountsTexturesThatAreNoBaseColours) {
  json document = textured({{"uri", data_uri(four_texels(), "image/png")}});
  document["textures"].push_back({{"source", 0}});
  document["materials"][0]["normalTexture"] = {{"index", 1}};
  EXPECT_THAT(load(document).report.warnings, Contains("textures ignored (1): only base colours are shown"));
}

TEST_F(GltfLooks, DroppedTrianglesTakeTheirLooksAlong) {
  json document = textured({{"uri", data_uri(four_texels(), "image/png")}});
  primitive(document)["attributes"]["NORMAL"] =
      add_accessor(document, std::vector<float>{1, 0, 1, 0, 1, 1, 0, 0, 1, 1, 1, 1}, tests::k_float, "VEC3");
  primitive(document)["indices"] =
      add_accessor(document, std::vector<std::uint16_t>{0, 0, 1, 0, 2, 3}, tests::k_u16, "SCALAR");
  const Scene scene = load(document);
  ASSERT_EQ(scene.geometry.triangles.size(), 1u);
  expect_places(scene, 0, {{{0, 1}, {0.25f, 0}, {0, 0}}});
  expect_normals(scene, 0, {{{1, 0, 1}, {0, 0, 1}, {1, 1, 1}}});
}

// ---- glTF normals ----

json with_normals(const std::vector<float>& normals) {
  json document = triangle();
  const std::size_t accessor = add_accessor(document, normals, tests::k_float, "VEC3");
  primitive(document)["attributes"]["NORMAL"] = accessor;
  return document;
}

TEST_F(GltfLooks, ReadsNormals) {
  const Scene scene = load(with_normals({0, 0, 2, 0.6f, 0, 0.8f, 1, 1, 1, 0, 0, 1}));
  expect_normals(scene, 0, {{{0, 0, 1}, {0.6f, 0, 0.8f}, {1, 1, 1}}});
  EXPECT_THAT(load(triangle()).geometry.normals, IsEmpty());
  looks_ = Looks::flat;
  EXPECT_THAT(load(with_normals({0, 0, 2, 0.6f, 0, 0.8f, 1, 1, 1, 0, 0, 1})).geometry.normals, IsEmpty());
}

/// (1, 0, 1), scaled by (2, 1, 1), stands on a surface whose slope is halved.
TEST_F(GltfLooks, TurnsNormalsAsItsNodesTurnSurfaces) {
  json document = with_normals({1, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  document["nodes"][0]["scale"] = {2, 1, 1};
  expect_normals(load(document), 0, {{{0.5f, 0, 1}, {0, 0, 1}, {0, 0, 1}}});
  // Mirrored, the corners go around the other way, and normals follow them to that side.
  document["nodes"][0]["scale"] = {-1, 1, 1};
  expect_normals(load(document), 0, {{{1, 0, -1}, {0, 0, -1}, {0, 0, -1}}});
}

TEST_F(GltfLooks, TurnsNormalsToTheSideOfTheirTriangle) {
  // All three together: one that leans over the edge stays as it is.
  expect_normals(load(with_normals({1, 0, -0.1f, 0, 0, 1, 0, 0, 1, 0, 0, 1})), 0,
                 {{{1, 0, -0.1f}, {0, 0, 1}, {0, 0, 1}}});
  expect_normals(load(with_normals({1, 0, 0.1f, 0, 0, -1, 0, 0, -1, 0, 0, 1})), 0,
                 {{{-1, 0, -0.1f}, {0, 0, 1}, {0, 0, 1}}});
}

TEST_F(GltfLooks, GivesCornersWithoutANormalThatOfTheirTriangle) {
  expect_normals(load(with_normals({0, 0, 0, k_nan, 0, 1, 1, 0, 1, 0, 0, 1})), 0,
                 {{{0, 0, 1}, {0, 0, 1}, {1, 0, 1}}});
}

TEST_F(GltfLooks, RefusesNormalsThatDoNotFit) {
  expect_error(with_normals({0, 0, 1}), "it has 1 normals for 4 vertices");
  json document = with_normals({0, 0, 1});
  document["accessors"].back()["type"] = "VEC2";
  expect_error(document, "normals must be vectors of three floats");
}

// ---- OBJ ----

const std::string k_square =
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 1 0 1\nvn 0 0 1\n";

TEST_F(ObjLooks, ReadsTexturesBesideTheMaterialFile) {
  std::filesystem::create_directories(folder_ / "mats/pictures");
  write("mats/pictures/four.png", four_texels());
  write("mats/m.mtl", "newmtl m\nKd 0.5 1 1\nmap_Kd -clamp on pictures\\four.png\n");
  const Scene scene = load("a.obj",
                           "mtllib mats/m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n"
                           "usemtl m\nf 1/1 2/2 3/3\n");
  ASSERT_EQ(scene.geometry.textures.size(), 1u);
  EXPECT_EQ(scene.geometry.textures[0].texels, tests::k_four_texels);
  EXPECT_EQ(material_of(scene, 0).albedo, glm::vec3(0.5f, 1, 1));
  EXPECT_EQ(material_of(scene, 0).wrap, (std::array{TextureWrap::clamp, TextureWrap::clamp}));
  expect_places(scene, 0, {{{0, 1}, {1, 1}, {1, 0}}});  // images begin at the bottom there
  EXPECT_THAT(scene.report.warnings, IsEmpty());
}

TEST_F(ObjLooks, MovesAndScalesTexturesByTheirOptions) {
  write("four.png", four_texels());
  write("m.mtl", "newmtl m\nmap_Kd -o 0.5 0.25 0 -s 2 3 1 four.png\n");
  expect_places(load("a.obj", k_square + "usemtl m\nf 1/1 2/2 3/3\n"), 0,
                {{{0.5f, 0.75f}, {2.5f, 0.75f}, {2.5f, -2.25f}}});
}

TEST_F(ObjLooks, ReadsWhatMasksCutOut) {
  const std::vector<glm::u8vec4> grey = {{10, 10, 10, 255}, {200, 200, 200, 255}};
  write("grey.png", png_file({2, 1}, grey));
  write("four.png", four_texels());
  const std::string face = k_square + "usemtl m\nf 1/1 2/2 3/3\n";
  write("m.mtl", "newmtl m\nmap_Kd -clamp on four.png\nmap_d -clamp on grey.png\n");
  const Scene scene = load("a.obj", face);
  const Material& material = material_of(scene, 0);
  ASSERT_TRUE(material.cut_out);
  EXPECT_EQ(material.cut_out->least_alpha, 0.5f);
  EXPECT_EQ(material.wrap[0], TextureWrap::clamp);
  EXPECT_NE(material.cut_out->texture, material.texture);
  const std::vector<glm::u8vec4>& mask = scene.geometry.textures.at(material.cut_out->texture).texels;
  EXPECT_EQ(mask.at(0).a, 10) << "an opaque image's red";
  EXPECT_EQ(mask.at(1).a, 200);
  EXPECT_THAT(scene.report.warnings, IsEmpty());

  // By a mask alone, moved; an image's alpha, where it has any.
  write("clear.png", png_file<glm::u8vec4>({1, 1}, {{255, 255, 255, 40}}));
  write("m.mtl", "newmtl m\nmap_d -s 2 2 1 clear.png\n");
  const Scene masked = load("a.obj", face);
  expect_places(masked, 0, {{{0, 1}, {2, 1}, {2, -1}}});
  EXPECT_EQ(masked.geometry.textures.at(material_of(masked, 0).cut_out->texture).texels.at(0).a, 40);

  write("m.mtl", "newmtl m\nmap_Kd four.png\nmap_d -s 2 2 1 grey.png\n");
  expect_error("a.obj", face, "material 'm': its map_Kd and its map_d lie differently");
  looks_ = Looks::flat;
  EXPECT_THAT(load("a.obj", face).report.warnings, Contains(HasSubstr("1 materials' masks (map_d) ignored")));
}

TEST_F(ObjLooks, ReadsNormalsOfTheCornersThatHaveThem) {
  write("m.mtl", "newmtl m\n");
  const Scene scene = load("a.obj", k_square + "f 1//1 2//2 3\nf 1 3 4\n");
  expect_normals(scene, 0, {{{1, 0, 1}, {0, 0, 1}, {0, 0, 1}}});
  expect_normals(scene, 1, {{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}});
}

TEST_F(ObjLooks, ShowsFacesWithoutPlacesInTheirMaterialsColour) {
  write("four.png", four_texels());
  write("m.mtl", "newmtl m\nKd 0.5 1 1\nmap_Kd four.png\n");
  const Scene scene = load("a.obj", k_square + "usemtl m\nf 1/1 2/2 3/3\nf 1 3 4\n");
  EXPECT_EQ(material_of(scene, 0).texture, 0u);
  EXPECT_EQ(material_of(scene, 1).texture, std::nullopt);
  EXPECT_EQ(material_of(scene, 1).albedo, glm::vec3(0.5f, 1, 1));
  EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("1 triangles without texture coordinates")));
}

TEST_F(ObjLooks, RefusesTexturesThatCannotBeShownAndNamesTheirMaterial) {
  write("m.mtl", "newmtl m\nmap_Kd none.png\n");
  const std::string face = k_square + "usemtl m\nf 1/1 2/2 3/3\n";
  expect_error("a.obj", face, "none.png: there is no such file");
  expect_error("a.obj", face, "a.obj, material 'm', texture");
  write("none.png", four_texels().substr(0, 60));
  expect_error("a.obj", face, "none.png': it is a broken PNG");
  write("none.png", four_texels());
  expect_error("a.obj", k_square + "usemtl m\nf 1/1 2/2 3/9\n",
               "a face at vertex 3: texture coordinate 9 is out of range: 4");
  expect_error("a.obj", k_square + "f 1//1 2//2 3//7\n", "a face at vertex 3: normal 7 is out of range: 2");
}

}  // namespace
}  // namespace airlight::scene
