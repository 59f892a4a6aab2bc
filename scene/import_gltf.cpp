#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tiny_gltf.h>
#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>

#include "scene/import_internal.h"
#include "scene/view_fields.h"

// Reads glTF 2.0. tinygltf leaves out, without a word, properties of a wrong type, and trusts offsets and
// counts: the JSON is checked before it sees it, and every accessor before it is read through.

namespace airlight::scene {
namespace {

constexpr std::string_view k_lights = "KHR_lights_punctual";
constexpr std::string_view k_transform = "KHR_texture_transform";
/// Real files stay below 20 levels of nesting; the recursion that walks the values must not meet thousands.
constexpr int k_most_nesting = 100;
/// Instances multiply: a small file can ask for more than any memory.
constexpr std::size_t k_most_elements = 200'000'000;

// ---- The text ----

/// What a property of the core of glTF must be for tinygltf not to overlook or misread it.
enum class Kind { index, size, number, numbers, indices, objects, strings, object };

bool is_unsigned(const nlohmann::json& value, std::uint64_t largest) {
  return value.is_number_unsigned() && value.get<std::uint64_t>() <= largest;
}

bool is_kind(const nlohmann::json& value, Kind kind, std::size_t length) {
  const auto is_index = [](const nlohmann::json& v) {
    return is_unsigned(v, std::numeric_limits<int>::max());
  };
  const auto all = [&](auto&& test) { return std::all_of(value.begin(), value.end(), test); };
  switch (kind) {
    case Kind::index:
      return is_index(value);
    case Kind::size:
      return is_unsigned(value, std::numeric_limits<std::uint32_t>::max());
    case Kind::number:
      return value.is_number();
    case Kind::numbers:
      return value.is_array() && value.size() == length && all([](const auto& v) { return v.is_number(); });
    case Kind::indices:
      return value.is_array() && all(is_index);
    case Kind::objects:
      return value.is_array() && all([](const auto& v) { return v.is_object(); });
    case Kind::strings:
      return value.is_array() && all([](const auto& v) { return v.is_string(); });
    case Kind::object:
      return value.is_object();
  }
  return false;
}

struct Rule {
  std::string_view key;
  Kind kind;
  std::size_t length = 0;
  Kind or_kind = kind;  ///< some keys mean two things, by where they stand
};

constexpr auto k_rules = std::to_array<Rule>({
    {"accessors", Kind::objects},
    {"alphaCutoff", Kind::number},
    {"attributes", Kind::object},
    {"baseColorFactor", Kind::numbers, 4},
    {"baseColorTexture", Kind::object},
    {"buffer", Kind::index},
    {"bufferView", Kind::index},
    {"bufferViews", Kind::objects},
    {"buffers", Kind::objects},
    {"byteLength", Kind::size},
    {"byteOffset", Kind::size},
    {"byteStride", Kind::size},
    {"camera", Kind::index},
    {"cameras", Kind::objects},
    {"children", Kind::indices},
    {"color", Kind::numbers, 3},
    {"componentType", Kind::index},
    {"count", Kind::size},
    {"emissiveFactor", Kind::numbers, 3},
    {"extensions", Kind::object},
    {"extensionsRequired", Kind::strings},
    {"extensionsUsed", Kind::strings},
    {"images", Kind::objects},
    {"index", Kind::index},
    {"indices", Kind::index, 0, Kind::object},
    {"innerConeAngle", Kind::number},
    {"intensity", Kind::number},
    {"light", Kind::index},
    {"lights", Kind::objects},
    {"material", Kind::index},
    {"materials", Kind::objects},
    {"matrix", Kind::numbers, 16},
    {"mesh", Kind::index},
    {"meshes", Kind::objects},
    {"mode", Kind::index},
    {"nodes", Kind::objects, 0, Kind::indices},
    {"outerConeAngle", Kind::number},
    {"pbrMetallicRoughness", Kind::object},
    {"perspective", Kind::object},
    {"primitives", Kind::objects},
    {"range", Kind::number},
    {"rotation", Kind::numbers, 4},
    {"sampler", Kind::index},
    {"samplers", Kind::objects},
    {"scale", Kind::numbers, 3, Kind::number},
    {"scene", Kind::index},
    {"scenes", Kind::objects},
    {"skin", Kind::index},
    {"source", Kind::index},
    {"sparse", Kind::object},
    {"spot", Kind::object},
    {"texCoord", Kind::index},
    {"textures", Kind::objects},
    {"translation", Kind::numbers, 3},
    {"wrapS", Kind::index},
    {"wrapT", Kind::index},
    {"yfov", Kind::number},
});

/// @param place the path to `value` from the root, as in "/nodes/3"
void check_properties(const std::filesystem::path& file, const nlohmann::json& value,
                      const std::string& place) {
  if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i)
      if (value[i].is_structured()) check_properties(file, value[i], fmt::format("{}/{}", place, i));
    return;
  }
  for (const auto& [key, property] : value.items()) {
    const std::string inner = fmt::format("{}/{}", place, printable(key));
    const auto rule = std::ranges::find(k_rules, key, &Rule::key);
    if (rule != k_rules.end() && !is_kind(property, rule->kind, rule->length) &&
        !is_kind(property, rule->or_kind, rule->length))
      throw file_error(file, inner,
                       fmt::format("glTF does not allow the value {} here", printable(property.dump())));
    if (key == "primitives")
      for (const nlohmann::json& primitive : property)
        if (!primitive.contains("attributes")) throw file_error(file, inner, "a primitive has no attributes");
    if (key == "attributes")
      for (const auto& [name, accessor] : property.items())
        if (!is_kind(accessor, Kind::index, 0))
          throw file_error(file, inner, fmt::format("attribute {} names no accessor", printable(name)));
    if (key == "extensions") {
      // Other extensions give our words meanings of their own.
      if (property.contains(k_lights))
        check_properties(file, property[k_lights], fmt::format("{}/{}", inner, k_lights));
    } else if (key != "extras" && property.is_structured()) {
      check_properties(file, property, inner);
    }
  }
}

bool is_binary(std::string_view bytes) {
  return bytes.starts_with("glTF");
}

/// The JSON text of a .gltf or .glb file. Checks the .glb container, in which tinygltf reads past the end.
std::string_view json_of(const std::filesystem::path& file, std::string_view bytes) {
  if (!is_binary(bytes)) return bytes;
  const auto word = [&](std::size_t offset) -> std::uint64_t {
    if (offset + 4 > bytes.size())
      throw file_error(file, "", fmt::format("the file ends inside a header, after {} bytes", bytes.size()));
    std::uint32_t result = 0;
    for (std::size_t i = 0; i < 4; ++i)
      result |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
    return result;
  };
  if (word(4) != 2)
    throw file_error(file, "", fmt::format("glTF version {} is not supported, only 2", word(4)));
  const std::uint64_t total = word(8), json_size = word(12);
  if (total > bytes.size())
    throw file_error(file, "", fmt::format("the file is cut off: {} of {} bytes", bytes.size(), total));
  if (20 + json_size > total) throw file_error(file, "", "the JSON chunk is longer than the file");
  const std::size_t binary = 20 + json_size;
  if (binary < total && binary + 8 + word(binary) > total)
    throw file_error(file, "", "the binary chunk is longer than the file");
  return bytes.substr(20, json_size);
}

/// The deepest nesting of a JSON text. (The parser could tell as well, but only in time quadratic in the
/// nodes.)
int nesting(std::string_view text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string && c == '\\')
      ++i;
    else if (c == '"')
      in_string = !in_string;
    else if (!in_string && (c == '[' || c == '{'))
      deepest = std::max(deepest, ++depth);
    else if (!in_string && (c == ']' || c == '}'))
      --depth;
  }
  return deepest;
}

/// What a file requires changes the meaning of everything else in it, so that it comes first.
void check_required_extensions(const std::filesystem::path& file, const nlohmann::json& document) {
  const auto required = document.find("extensionsRequired");
  if (required == document.end() || !is_kind(*required, Kind::strings, 0)) return;
  std::string unsupported;
  for (const nlohmann::json& name : *required)
    if (name != k_lights && name != k_transform)
      unsupported += fmt::format("{}{}", unsupported.empty() ? "" : ", ", printable(name.get<std::string>()));
  if (unsupported.empty()) return;
  const bool are_several = unsupported.find(',') != std::string::npos;
  throw file_error(file, "",
                   fmt::format("it requires the extension{} {}, which {} not supported",
                               are_several ? "s" : "", unsupported, are_several ? "are" : "is"),
                   are_several ? "export it without them" : "export it without that extension");
}

void check_json(const std::filesystem::path& file, std::string_view text) {
  if (nesting(text) > k_most_nesting)
    throw file_error(file, "", fmt::format("its JSON is nested more than {} levels deep", k_most_nesting));
  nlohmann::json document;
  try {
    document = nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw file_error(file, "", fmt::format("its JSON is broken: {}", printable(error.what())));
  }
  if (!document.is_object()) throw file_error(file, "", "its JSON is not an object");
  check_required_extensions(file, document);
  check_properties(file, document, "");
}

// ---- Loading through tinygltf ----

// tinygltf also looks in the working folder, where a file of the same name is another one: relative paths are
// refused.
bool file_exists(const std::string& name, void*) {
  std::error_code error;
  return std::filesystem::path(name).is_absolute() && std::filesystem::is_regular_file(name, error);
}

std::string same_path(const std::string& name, void*) {
  return name;
}

bool read_buffer(std::vector<unsigned char>* bytes, std::string* message, const std::string& name, void*) {
  try {
    const std::string text = read_file(name);
    bytes->assign(text.begin(), text.end());
    return true;
  } catch (const Error& error) {
    *message += error.what();
    return false;
  }
}

/// Keeps the bytes of an image of its own, undecoded. (Where it lies in a buffer, they are kept there, and
/// tinygltf has not checked that they do.)
bool keep_image(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes,
                int size, void*) {
  if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
  return true;
}

bool skip_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                void*) {
  return true;
}

tinygltf::Model load(const std::filesystem::path& file, const std::string& bytes, Looks looks) {
  if (bytes.size() > std::numeric_limits<unsigned int>::max())
    throw file_error(file, "", "the file is larger than 4 GiB",
                     "split it, or keep its buffers in files of their own");
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks({file_exists, same_path, read_buffer, nullptr, nullptr});
  loader.SetImageLoader(looks == Looks::textured ? keep_image : skip_image, nullptr);

  tinygltf::Model model;
  std::string errors, warnings;  // the warnings are about images only: one that lacks bytes is told of later
  const std::string folder = std::filesystem::absolute(file).parent_path().string();
  const auto size = static_cast<unsigned int>(bytes.size());
  const bool loaded =
      is_binary(bytes)
          ? loader.LoadBinaryFromMemory(&model, &errors, &warnings,
                                        reinterpret_cast<const unsigned char*>(bytes.data()), size, folder)
          : loader.LoadASCIIFromString(&model, &errors, &warnings, bytes.data(), size, folder);
  // What it calls an error and goes on is none (a skin may well lack inverse bind matrices).
  if (!loaded) throw file_error(file, "", errors.empty() ? "it is no glTF file" : printable(errors));
  return model;
}

// ---- The scene ----

/// Turns a loaded model into a scene: one object a file.
class Importer {
 public:
  Importer(const std::filesystem::path& file, const tinygltf::Model& model, Looks looks)
      : file_(file), model_(model), looks_(looks) {}

  Scene import() {
    warn_of_extensions();
    read_materials();
    walk_nodes();
    count_textures();
    count(model_.animations.size(), "animations", "the scene is shown at rest");
    report_counts();
    count_warning(scene_.report, untextured_triangles_, k_untextured);

    raw_.place_of_vertex = [this](std::size_t vertex) { return place_of_vertex(vertex); };
    scene_.geometry = clean(file_, std::move(raw_), scene_.report);
    return std::move(scene_);
  }

 private:
  /// Where equally spaced elements of a buffer lie; all of them inside the buffer.
  struct Elements {
    const unsigned char* first;
    std::size_t stride;
    const unsigned char* operator[](std::size_t i) const { return first + i * stride; }
  };

  /// A run of positions that came from one primitive.
  struct Run {
    std::size_t first;
    std::string place;
  };

  Error error(const std::string& place, const std::string& problem, const std::string& remedy = {}) const {
    return file_error(file_, place, problem, remedy);
  }

  static std::string place(std::string_view kind, std::size_t index, const std::string& name) {
    return name.empty() ? fmt::format("{} {}", kind, index)
                        : fmt::format("{} {} '{}'", kind, index, printable(name));
  }

  /// An element of one of the model's arrays. @throws Error when there is none of that index.
  template <typename T>
  const T& at(const std::vector<T>& all, int index, std::string_view kind, const std::string& user) const {
    if (index < 0 || static_cast<std::size_t>(index) >= all.size())
      throw error(user, fmt::format("{} {} does not exist: there are {}", kind, index, all.size()));
    return all[static_cast<std::size_t>(index)];
  }

  // -- What is left out --

  void count(std::size_t number, std::string_view kind, std::string_view reason) {
    if (number > 0) counts_[{std::string(kind), std::string(reason)}] += number;
  }

  void report_counts() {
    for (const auto& [what, number] : counts_)
      scene_.report.warnings.push_back(fmt::format("{} ignored ({}): {}", what.first, number, what.second));
  }

  void warn_of_extensions() {
    for (const std::string& name : model_.extensionsUsed)
      if (name != k_lights && name != k_transform)
        scene_.report.warnings.push_back(
            fmt::format("extension {} ignored: what it adds is not shown", printable(name)));
  }

  // -- Materials --

  void read_materials() {
    for (std::size_t i = 0; i < model_.materials.size(); ++i) {
      const tinygltf::Material& material = model_.materials[i];
      const std::vector<double>& color = material.pbrMetallicRoughness.baseColorFactor;
      const std::string where = place("material", i, material.name);
      Material& read = raw_.materials.emplace_back();
      read.albedo = albedo(file_, where, {color[0], color[1], color[2]});
      const tinygltf::TextureInfo& texture = material.pbrMetallicRoughness.baseColorTexture;
      places_.emplace_back();
      if (looks_ == Looks::textured && texture.index >= 0) read_texture(texture, where, read, places_.back());

      const std::vector<double>& emission = material.emissiveFactor;
      count(std::ranges::any_of(emission, [](double e) { return e != 0.0; }), "light of emissive materials",
            "only point lights, spots and suns are rendered");
      if (material.alphaMode == "MASK") read_mask(material, color[3], read);
      if (material.alphaMode == "BLEND") read_blend(material, color[3], read);
      count(material.extensions.contains("KHR_materials_transmission"), "transmission of materials",
            "surfaces are opaque");
    }
    // glTF's default material, for primitives without one.
    default_material_ = static_cast<std::uint32_t>(raw_.materials.size());
    raw_.materials.push_back({glm::vec3(1.0f)});
    places_.emplace_back();
  }

  /// What is covered reflects the base colour, and what is not lets light of that colour through.
  void read_blend(const tinygltf::Material& material, double alpha, Material& read) {
    count(material.pbrMetallicRoughness.baseColorTexture.index >= 0, "textures of transparent materials",
          "light passes as by their factors alone");
    read.transmittance = static_cast<float>(1.0 - alpha) * read.albedo;
    read.albedo *= static_cast<float>(alpha);
  }

  /// Where the product of the texture's alpha and the material's is less than the cutoff, there is nothing.
  void read_mask(const tinygltf::Material& material, double alpha, Material& read) {
    const double cutoff = material.alphaCutoff;
    if (looks_ == Looks::flat) return count(1, "alpha masks of materials", "surfaces are opaque");
    if (cutoff <= 0.0) return;
    if (alpha < cutoff)
      nothing_.insert(raw_.materials.size() - 1);
    else if (read.texture)
      read.cut_out = {*read.texture, static_cast<float>(cutoff / alpha)};
  }

  // -- Textures --

  /// How a material's texture lies on a primitive.
  struct Placing {
    int set = 0;  ///< of the primitive's TEXCOORD_n
    // KHR_texture_transform:
    glm::dvec2 offset{0.0}, scale{1.0};
    double rotation = 0.0;  ///< [rad]

    glm::dvec2 operator()(glm::dvec2 place) const {
      const glm::dvec2 scaled = scale * place;
      const double c = std::cos(rotation), s = std::sin(rotation);
      return offset + glm::dvec2(c * scaled.x + s * scaled.y, c * scaled.y - s * scaled.x);
    }
  };

  static TextureWrap wrap_of(int mode) {
    return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? TextureWrap::clamp
           : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? TextureWrap::mirror
                                                           : TextureWrap::repeat;
  }

  void read_texture(const tinygltf::TextureInfo& info, const std::string& where, Material& material,
                    Placing& placing) {
    const tinygltf::Texture& texture = at(model_.textures, info.index, "texture", where);
    if (texture.source < 0)
      throw texture_error(file_, where, fmt::format("{}", info.index), "it names no image");
    material.texture = read_image(texture.source, where);
    if (texture.sampler >= 0) {
      const tinygltf::Sampler& sampler = at(model_.samplers, texture.sampler, "sampler", where);
      material.wrap = {wrap_of(sampler.wrapS), wrap_of(sampler.wrapT)};
    }
    placing.set = info.texCoord;
    if (const auto transform = info.extensions.find(std::string(k_transform));
        transform != info.extensions.end())
      read_transform(transform->second, fmt::format("{}, {}", where, k_transform), placing);
  }

  void read_transform(const tinygltf::Value& transform, const std::string& where, Placing& placing) const {
    const auto number = [&](const tinygltf::Value& value, const std::string& name) {
      if (!value.IsNumber() || !std::isfinite(value.GetNumberAsDouble()))
        throw error(where, fmt::format("its {} is not a finite number", name));
      return value.GetNumberAsDouble();
    };
    const auto set_pair = [&](const std::string& name, glm::dvec2& pair) {
      if (!transform.Has(name)) return;
      const tinygltf::Value& value = transform.Get(name);
      if (!value.IsArray() || value.ArrayLen() != 2)
        throw error(where, fmt::format("its {} is not two numbers", name));
      pair = {number(value.Get(0), name), number(value.Get(1), name)};
    };
    set_pair("offset", placing.offset);
    set_pair("scale", placing.scale);
    if (transform.Has("rotation")) placing.rotation = number(transform.Get("rotation"), "rotation");
    if (transform.Has("texCoord")) {
      if (!transform.Get("texCoord").IsInt()) throw error(where, "its texCoord is not a whole number");
      placing.set = transform.Get("texCoord").GetNumberAsInt();
    }
  }

  /// @returns which of Geometry::textures it is; each image is decoded once
  std::uint32_t read_image(int index, const std::string& where) {
    const auto [known, is_new] =
        texture_of_image_.try_emplace(index, static_cast<std::uint32_t>(raw_.textures.size()));
    if (!is_new) return known->second;
    const tinygltf::Image& image = at(model_.images, index, "image", where);
    const std::string name = image.uri.empty() ? place("image", static_cast<std::size_t>(index), image.name)
                                               : fmt::format("'{}'", printable(image.uri));
    std::span<const unsigned char> bytes = image.image;
    if (image.bufferView >= 0) {
      const std::size_t size = at(model_.bufferViews, image.bufferView, "buffer view", where).byteLength;
      if (size > 0) bytes = {elements(image.bufferView, 0, 1, size, true, where).first, size};
    } else if (bytes.empty()) {
      throw texture_error(file_, where, name, "there is no such file");
    }
    raw_.textures.push_back(texture_image(file_, where, name, bytes));
    return known->second;
  }

  void count_textures() {
    std::size_t shown = 0;
    if (looks_ == Looks::textured) {
      std::vector<bool> is_shown(model_.textures.size(), false);
      for (const tinygltf::Material& material : model_.materials)
        if (const int index = material.pbrMetallicRoughness.baseColorTexture.index; index >= 0)
          is_shown[static_cast<std::size_t>(index)] = true;
      shown = static_cast<std::size_t>(std::ranges::count(is_shown, true));
    }
    count(model_.textures.size() - shown, "textures",
          looks_ == Looks::textured ? "only base colours are shown" : "surfaces have one colour");
  }

  // -- Nodes --

  static glm::dvec3 dvec3_of(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

  Node read_node(const tinygltf::Node& source, const std::string& where) const {
    Node node{.name = source.name};
    if (!source.matrix.empty()) {
      node.matrix = glm::make_mat4(source.matrix.data());
      if (glm::row(*node.matrix, 3) != glm::dvec4(0.0, 0.0, 0.0, 1.0))
        throw error(where, "the last row of its matrix is not 0, 0, 0, 1");
      return node;
    }
    if (!source.translation.empty()) node.translation = dvec3_of(source.translation);
    if (!source.rotation.empty()) {
      const std::vector<double>& r = source.rotation;
      const glm::dquat rotation(r[3], r[0], r[1], r[2]);
      if (!is_unit_quaternion(rotation))
        throw error(where, fmt::format("its rotation is not a unit quaternion: its length is {:g}",
                                       glm::length(rotation)));
      node.rotation = glm::normalize(rotation);
    }
    if (!source.scale.empty()) node.scale = dvec3_of(source.scale);
    return node;
  }

  /// The nodes of the default scene, of the first one, or, without scenes, those that are no node's child.
  std::vector<int> roots() const {
    if (!model_.scenes.empty())
      return at(model_.scenes, std::max(model_.defaultScene, 0), "scene", "scene").nodes;
    std::vector<bool> is_child(model_.nodes.size(), false);
    for (const tinygltf::Node& node : model_.nodes)
      for (int child : node.children)
        if (static_cast<std::size_t>(child) < is_child.size())
          is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> result;
    for (std::size_t i = 0; i < is_child.size(); ++i)
      if (!is_child[i]) result.push_back(static_cast<int>(i));
    return result;
  }

  void walk_nodes() {
    struct Visit {
      int node;
      glm::dmat4 world_from_parent;
      std::string parent;
      std::optional<std::uint32_t> parent_index;
    };
    // Depth first in the file's order, without recursion: chains of nodes can be as long as the file.
    std::vector<Visit> visits;
    const auto add = [&](const std::vector<int>& nodes, const glm::dmat4& world_from_parent,
                         const std::string& parent, std::optional<std::uint32_t> parent_index) {
      for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
        visits.push_back({*node, world_from_parent, parent, parent_index});
    };
    add(roots(), glm::dmat4(1.0), "scene", {});
    scene_.nodes.resize(model_.nodes.size());
    for (std::size_t i = 0; i < model_.nodes.size(); ++i) scene_.nodes[i].name = model_.nodes[i].name;
    while (!visits.empty()) {
      const Visit visit = std::move(visits.back());
      visits.pop_back();
      const tinygltf::Node& node = at(model_.nodes, visit.node, "node", visit.parent);
      const auto index = static_cast<std::size_t>(visit.node);
      const std::string where = place("node", index, node.name);
      Node& read = scene_.nodes[index];
      if (read.is_shown) throw error(where, "it has two parents, or is its own ancestor");
      read = read_node(node, where);
      read.parent = visit.parent_index;
      read.is_shown = true;

      const glm::dmat4 world_from_node = visit.world_from_parent * parent_from_node(read);
      count(node.skin >= 0, "skins", "meshes are shown at rest");
      if (node.mesh >= 0) add_mesh(node, world_from_node, where);
      raw_.node_of_triangle.resize(raw_.triangles.size(), static_cast<std::uint32_t>(index));
      const std::size_t before = scene_.cameras.size() + scene_.lights.size();
      if (node.camera >= 0) add_camera(node, world_from_node, where);
      if (node.extensions.contains(std::string(k_lights))) add_light(node, world_from_node, where);
      read.cameras_and_lights = scene_.cameras.size() + scene_.lights.size() - before;
      add(node.children, world_from_node, where, static_cast<std::uint32_t>(index));
    }
  }

  // -- Cameras and lights --

  static std::string name_of(const std::string& own, const std::string& node, std::string_view kind,
                             std::size_t number) {
    return !own.empty()    ? printable(own)
           : !node.empty() ? printable(node)
                           : fmt::format("{}{}", kind, number);
  }

  void add_camera(const tinygltf::Node& node, const glm::dmat4& world_from_node, const std::string& where) {
    const tinygltf::Camera& source = at(model_.cameras, node.camera, "camera", where);
    if (source.type != "perspective") {
      count(1, "orthographic cameras", "only perspective views are rendered");
      return;
    }
    Camera camera;
    camera.name = name_of(source.name, node.name, "camera", scene_.cameras.size());
    const glm::dvec3 forward(-world_from_node[2]), up(world_from_node[1]);
    camera.eye = glm::dvec3(world_from_node[3]);
    camera.target = camera.eye + glm::normalize(forward);
    camera.up = glm::normalize(up);
    camera.vertical_fov_degrees = glm::degrees(source.perspective.yfov);
    try {
      camera_frame(camera, {1, 1});
    } catch (const Error& problem) {
      throw error(where, printable(problem.what()));
    }
    scene_.cameras.push_back(camera);
  }

  void add_light(const tinygltf::Node& node, const glm::dmat4& world_from_node, const std::string& where) {
    const tinygltf::Value& reference = node.extensions.at(std::string(k_lights));
    if (!reference.Has("light")) throw error(where, fmt::format("{} names no light", k_lights));
    const int index = reference.Get("light").GetNumberAsInt();
    const tinygltf::Light& source = at(model_.lights, index, "light", where);
    if (source.type != "point" && source.type != "spot" && source.type != "directional") {
      count(1, "lights of unknown type", "only point lights, spots and suns are rendered");
      return;
    }

    Light light;
    light.name = name_of(source.name, node.name, "light", scene_.lights.size());
    const glm::dvec3 color = source.color.empty() ? glm::dvec3(1.0) : dvec3_of(source.color);
    const glm::vec3 power(color * source.intensity);
    for (int i = 0; i < 3; ++i)
      if (!(std::isfinite(power[i]) && power[i] >= 0.0f))
        throw error(where, fmt::format("the light's intensity {:g} is not finite and non-negative",
                                       color[i] * source.intensity));
    const auto set = [&](std::string_view name, const FieldValue& value, std::string_view what) {
      if (const auto wrong = field<Light>(name).set(light, value))
        throw error(where, fmt::format("the light's {}: {}", what, wrong->problem));
    };
    // It shines along the node's −Z.
    const glm::dvec3 backward(world_from_node[2]);
    if (source.type != "point")
      if (const auto wrong = field<Light>("sun").problem(backward))
        throw error(where, "the light's direction: " + wrong->problem);
    if (source.type == "directional") {
      light.kind = LightKind::sun;
      light.towards = unit(backward);
      light.irradiance = power;
    } else {
      light.position = glm::dvec3(world_from_node[3]);
      for (int i = 0; i < 3; ++i)
        if (!std::isfinite(light.position[i])) throw error(where, "the light's position is not finite");
      light.intensity = power;
      // A file without a range looks like one that says 0, as some do to mean none.
      if (source.range != 0.0) set("range", source.range, "range");
    }
    if (source.type == "spot") {
      light.cone.emplace().axis = -unit(backward);
      // Files are in single precision, where a right angle is a little more than one.
      const double outer = source.spot.outerConeAngle, right_angle = 0.5 * std::numbers::pi;
      const bool is_half_space = static_cast<float>(outer) == static_cast<float>(right_angle);
      set("spot-angles",
          glm::degrees(glm::dvec2(source.spot.innerConeAngle, is_half_space ? right_angle : outer)), "cone");
    }
    scene_.lights.push_back(light);
  }

  // -- Accessors --

  /// @param count must not be zero
  Elements elements(int view_index, std::size_t offset, std::size_t count, std::size_t element_size,
                    bool may_have_stride, const std::string& where) const {
    const tinygltf::BufferView& view = at(model_.bufferViews, view_index, "buffer view", where);
    const std::string view_place = fmt::format("buffer view {}", view_index);
    const tinygltf::Buffer& buffer = at(model_.buffers, view.buffer, "buffer", view_place);
    if (view.byteOffset > buffer.data.size() || view.byteLength > buffer.data.size() - view.byteOffset)
      throw error(view_place, fmt::format("it reaches to byte {} of a buffer of {}",
                                          view.byteOffset + view.byteLength, buffer.data.size()));
    const std::size_t stride = view.byteStride == 0 ? element_size : view.byteStride;
    if (stride < element_size || (stride != element_size && !may_have_stride))
      throw error(where,
                  fmt::format("a stride of {} bytes does not fit its elements of {}", stride, element_size));
    // All of these come from 32 bits, so 64 hold their products and sums.
    const std::size_t end = offset + (count - 1) * stride + element_size;
    if (end > view.byteLength)
      throw error(where, fmt::format("its {} elements reach to byte {} of a buffer view of {}", count, end,
                                     view.byteLength));
    return {buffer.data.data() + view.byteOffset + offset, stride};
  }

  static std::size_t index_size(int component_type) {
    switch (component_type) {
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
      case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return 4;
      default:
        return 0;
    }
  }

  static std::uint32_t index_at(const unsigned char* bytes, std::size_t size) {
    std::uint32_t index = 0;
    for (std::size_t i = 0; i < size; ++i) index |= std::uint32_t{bytes[i]} << (8 * i);
    return index;
  }

  void check_count(std::size_t count, const std::string& where) const {
    if (count == 0) throw error(where, "it is empty");
    if (count > k_most_elements)
      throw error(where, fmt::format("{} elements are more than the limit of {}", count, k_most_elements));
  }

  std::vector<std::uint32_t> read_indices(int accessor_index, const std::string& user) const {
    const tinygltf::Accessor& accessor = at(model_.accessors, accessor_index, "accessor", user);
    const std::string where = fmt::format("accessor {}", accessor_index);
    const std::size_t size = index_size(accessor.componentType);
    if (size == 0 || accessor.type != TINYGLTF_TYPE_SCALAR)
      throw error(where, "indices must be scalars of 8, 16 or 32 unsigned bits");
    if (accessor.sparse.isSparse) throw error(where, "sparse indices are not supported");
    check_count(accessor.count, where);
    const Elements source =
        elements(accessor.bufferView, accessor.byteOffset, accessor.count, size, false, where);
    std::vector<std::uint32_t> indices(accessor.count);
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = index_at(source[i], size);
    return indices;
  }

  std::vector<glm::dvec3> read_float_vectors(int accessor_index, std::string_view what,
                                             const std::string& user) const {
    const tinygltf::Accessor& accessor = at(model_.accessors, accessor_index, "accessor", user);
    const std::string where = fmt::format("accessor {}", accessor_index);
    if (accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT || accessor.type != TINYGLTF_TYPE_VEC3)
      throw error(where, fmt::format("{} must be vectors of three floats", what));
    return read_vectors(accessor, where, 3);
  }

  /// Places in a texture.
  std::vector<glm::dvec3> read_places(int accessor_index, const std::string& user) const {
    const tinygltf::Accessor& accessor = at(model_.accessors, accessor_index, "accessor", user);
    const std::string where = fmt::format("accessor {}", accessor_index);
    const int type = accessor.componentType;
    const bool is_fraction = accessor.normalized && (type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                                                     type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT);
    if ((type != TINYGLTF_COMPONENT_TYPE_FLOAT && !is_fraction) || accessor.type != TINYGLTF_TYPE_VEC2)
      throw error(where,
                  "texture coordinates must be pairs of floats, or of normalized 8 or 16 unsigned bits");
    return read_vectors(accessor, where, 2);
  }

  /// Of as many components, each a float or a fraction in unsigned bits.
  std::vector<glm::dvec3> read_vectors(const tinygltf::Accessor& accessor, const std::string& where,
                                       int components) const {
    check_count(accessor.count, where);
    const std::size_t bits_size = index_size(accessor.componentType);
    const bool is_float = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
    const std::size_t component_size = is_float ? sizeof(float) : bits_size;
    const std::size_t size_of_one = static_cast<std::size_t>(components) * component_size;
    const auto vector_at = [&](const unsigned char* bytes) {
      glm::dvec3 v(0.0);
      for (int i = 0; i < components; ++i, bytes += component_size) {
        float number = 0.0f;
        if (is_float) std::memcpy(&number, bytes, sizeof number);
        v[i] = is_float
                   ? static_cast<double>(number)
                   : index_at(bytes, bits_size) / (std::exp2(8.0 * static_cast<double>(bits_size)) - 1.0);
      }
      return v;
    };

    std::vector<glm::dvec3> vectors(accessor.count, glm::dvec3(0.0));
    if (accessor.bufferView >= 0) {
      const Elements source =
          elements(accessor.bufferView, accessor.byteOffset, accessor.count, size_of_one, true, where);
      for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = vector_at(source[i]);
    } else if (!accessor.sparse.isSparse) {
      throw error(where, "it has no data");
    }

    if (accessor.sparse.isSparse) {
      const auto& sparse = accessor.sparse;
      const std::size_t size = index_size(sparse.indices.componentType);
      if (size == 0) throw error(where, "its sparse indices must be of 8, 16 or 32 unsigned bits");
      if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > vectors.size() ||
          sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        throw error(where, "its sparse part is broken");
      const auto replaced = static_cast<std::size_t>(sparse.count);
      const Elements index =
          elements(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), replaced,
                   size, false, where);
      const Elements value =
          elements(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), replaced,
                   size_of_one, false, where);
      for (std::size_t i = 0; i < replaced; ++i) {
        const std::uint32_t target = index_at(index[i], size);
        if (target >= vectors.size())
          throw error(where,
                      fmt::format("sparse index {} is out of range: {} elements", target, vectors.size()));
        vectors[target] = vector_at(value[i]);
      }
    }
    return vectors;
  }

  // -- Meshes --

  void add_mesh(const tinygltf::Node& node, const glm::dmat4& world_from_node,
                const std::string& node_place) {
    const tinygltf::Mesh& mesh = at(model_.meshes, node.mesh, "mesh", node_place);
    const std::string mesh_place = place("mesh", static_cast<std::size_t>(node.mesh), mesh.name);
    // Primitives often share one array of positions.
    std::map<int, std::size_t> first_of_accessor;
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = mesh.primitives[i];
      const std::string where = fmt::format("{}, primitive {}", mesh_place, i);
      if (primitive.mode < TINYGLTF_MODE_POINTS || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        throw error(where, fmt::format("there is no primitive mode {}", primitive.mode));
      if (primitive.mode < TINYGLTF_MODE_TRIANGLES) {
        count(1, "primitives of points or lines", "only triangles are rendered");
        continue;
      }
      count(!primitive.targets.empty(), "morph targets of primitives", "meshes are shown at rest");
      count(primitive.attributes.contains("COLOR_0"), "vertex colours of primitives",
            "surfaces have one colour");

      const auto attribute = primitive.attributes.find("POSITION");
      if (attribute == primitive.attributes.end()) throw error(where, "it has no positions");
      const tinygltf::Accessor& accessor = at(model_.accessors, attribute->second, "accessor", where);
      const auto [known, is_new] = first_of_accessor.try_emplace(attribute->second, raw_.positions.size());
      if (is_new) {
        runs_.push_back({raw_.positions.size(), where});
        for (glm::dvec3 position : read_float_vectors(attribute->second, "positions", where))
          raw_.positions.push_back(glm::dvec3(world_from_node * glm::dvec4(position, 1.0)));
      }
      if (nothing_.contains(static_cast<std::size_t>(primitive.material))) {
        count(1, "primitives whose material cuts all of them away", "nothing of them is there");
        continue;
      }
      const std::size_t first_triangle = raw_.triangles.size();
      add_triangles(primitive, known->second, accessor.count, where);
      if (std::max(raw_.positions.size(), raw_.triangles.size()) > k_most_elements)
        throw error(where,
                    fmt::format("with it the scene has more than {} vertices or triangles", k_most_elements));
      if (looks_ == Looks::flat) continue;
      add_texture_places(primitive, known->second, accessor.count, first_triangle, where);
      add_normals(primitive, world_from_node, known->second, accessor.count, first_triangle, where);
    }
  }

  void add_triangles(const tinygltf::Primitive& primitive, std::size_t first, std::size_t vertices,
                     const std::string& where) {
    std::vector<std::uint32_t> indices;
    if (primitive.indices >= 0) indices = read_indices(primitive.indices, where);
    const std::size_t corners = primitive.indices >= 0 ? indices.size() : vertices;
    const auto vertex = [&](std::size_t corner) {
      const std::size_t index = primitive.indices >= 0 ? indices[corner] : corner;
      if (index >= vertices)
        throw error(where, fmt::format("index {} is out of range: {} vertices", index, vertices));
      return static_cast<std::uint32_t>(first + index);
    };

    std::uint32_t material = default_material_;
    if (primitive.material >= 0) {
      at(model_.materials, primitive.material, "material", where);
      material = static_cast<std::uint32_t>(primitive.material);
    }

    const bool separate = primitive.mode == TINYGLTF_MODE_TRIANGLES;
    if (corners < 3 || (separate && corners % 3 != 0))
      throw error(where, fmt::format("{} corners do not make up triangles", corners));
    const std::size_t triangles = separate ? corners / 3 : corners - 2;
    for (std::size_t i = 0; i < triangles; ++i) {
      if (separate)
        raw_.triangles.emplace_back(vertex(3 * i), vertex(3 * i + 1), vertex(3 * i + 2));
      else if (primitive.mode ==
               TINYGLTF_MODE_TRIANGLE_STRIP)  // every other one is turned to face the same way
        raw_.triangles.emplace_back(vertex(i), vertex(i + 1 + i % 2), vertex(i + 2 - i % 2));
      else
        raw_.triangles.emplace_back(vertex(i + 1), vertex(i + 2), vertex(0));
    }
    raw_.material_of_triangle.resize(raw_.triangles.size(), material);
  }

  /// Of the primitive's triangles, the last ones, where their material has a texture.
  void add_texture_places(const tinygltf::Primitive& primitive, std::size_t first, std::size_t vertices,
                          std::size_t first_triangle, const std::string& where) {
    const std::size_t material = raw_.material_of_triangle[first_triangle];
    if (!is_textured(raw_.materials[material])) return;
    const Placing& placing = places_[material];
    const std::string name = fmt::format("TEXCOORD_{}", placing.set);
    const auto attribute = primitive.attributes.find(name);
    if (attribute == primitive.attributes.end()) {
      const std::uint32_t plain = untextured(raw_, static_cast<std::uint32_t>(material), untextured_);
      std::fill(raw_.material_of_triangle.begin() + static_cast<std::ptrdiff_t>(first_triangle),
                raw_.material_of_triangle.end(), plain);
      untextured_triangles_ += raw_.triangles.size() - first_triangle;
      return;
    }
    const std::vector<glm::dvec3> places = read_places(attribute->second, where);
    if (places.size() != vertices)
      throw error(where, fmt::format("it has {} {} for {} vertices", places.size(), name, vertices));
    raw_.texture_places.resize(raw_.triangles.size());
    for (std::size_t i = first_triangle; i < raw_.triangles.size(); ++i)
      for (int corner = 0; corner < 3; ++corner)
        raw_.texture_places[i][static_cast<std::size_t>(corner)] =
            placing(glm::dvec2(places[raw_.triangles[i][corner] - first]));
  }

  /// As `add_texture_places`, where it has normals.
  void add_normals(const tinygltf::Primitive& primitive, const glm::dmat4& world_from_node, std::size_t first,
                   std::size_t vertices, std::size_t first_triangle, const std::string& where) {
    const auto attribute = primitive.attributes.find("NORMAL");
    if (attribute == primitive.attributes.end()) return;
    const std::vector<glm::dvec3> normals = read_float_vectors(attribute->second, "normals", where);
    if (normals.size() != vertices)
      throw error(where, fmt::format("it has {} normals for {} vertices", normals.size(), vertices));
    // The cofactors turn normals as the matrix turns surfaces, whatever it does to lengths.
    const glm::dmat3 m(world_from_node);
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    raw_.normals.resize(raw_.triangles.size());
    for (std::size_t i = first_triangle; i < raw_.triangles.size(); ++i)
      for (int corner = 0; corner < 3; ++corner)
        raw_.normals[i][static_cast<std::size_t>(corner)] =
            cofactors * normals[raw_.triangles[i][corner] - first];
  }

  std::string place_of_vertex(std::size_t vertex) const {
    const auto after = std::upper_bound(runs_.begin(), runs_.end(), vertex,
                                        [](std::size_t v, const Run& run) { return v < run.first; });
    const Run& run = *std::prev(after);
    return fmt::format("{}, vertex {}", run.place, vertex - run.first);
  }

  const std::filesystem::path& file_;
  const tinygltf::Model& model_;
  Looks looks_;
  Scene scene_;
  RawGeometry raw_;
  std::vector<Placing> places_;         ///< of each material's texture
  std::uint32_t default_material_ = 0;  ///< of `raw_.materials`
  std::set<std::size_t> nothing_;       ///< materials that cut away all of their triangles
  std::map<int, std::uint32_t> texture_of_image_;
  std::map<std::uint32_t, std::uint32_t>
      untextured_;  ///< materials, by those that they are without a texture
  std::size_t untextured_triangles_ = 0;
  std::vector<Run> runs_;                                              ///< in the order of `raw_.positions`
  std::map<std::pair<std::string, std::string>, std::size_t> counts_;  ///< of a kind and a reason
};

}  // namespace

Scene import_gltf(const std::filesystem::path& file, Looks looks) {
  const std::string bytes = read_file(file);
  check_json(file, json_of(file, bytes));
  const tinygltf::Model model = load(file, bytes, looks);
  return Importer(file, model, looks).import();
}

}  // namespace airlight::scene
