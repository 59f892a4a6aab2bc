#include "gpu/spirv.h"

#include <cassert>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace airlight::gpu {
namespace {

using Id = std::uint32_t;
using Words = std::span<const std::uint32_t>;

/// What the declarations say about ids; the names are those of the SPIR-V specification, section 3.
class Declarations {
 public:
  void add(std::uint32_t opcode, Words operands) {
    enum {
      k_type_image = 25,
      k_type_sampled_image = 27,
      k_type_array = 28,
      k_type_struct = 30,
      k_type_pointer = 32,
      k_constant = 43,
      k_spec_constant = 50,
      k_variable = 59,
      k_decorate = 71,
      k_member_decorate = 72
    };
    switch (opcode) {
      case k_type_image:
        kinds_[operands[0]] =
            operands[6] == 2 ? SpirvResource::Kind::image : SpirvResource::Kind::sampler;  // Sampled
        break;
      case k_type_sampled_image:
        kinds_[operands[0]] = SpirvResource::Kind::sampler;
        break;
      case k_type_array:
        arrays_[operands[0]] = {operands[1], operands[2]};
        break;
      case k_type_struct:
        member_counts_[operands[0]] = operands.size() - 1;
        break;
      case k_type_pointer:
        pointees_[operands[0]] = operands[2];
        break;
      case k_constant:
      case k_spec_constant:
        constants_[operands[1]] = operands[2];
        break;
      case k_variable:
        variables_.push_back({operands[1], pointees_[operands[0]], operands[2]});
        break;
      case k_decorate:
        decorate(operands);
        break;
      case k_member_decorate:
        if (operands[2] == k_non_writable) non_writable_members_.emplace(operands[0], operands[1]);
        break;
      default:
        break;
    }
  }

  SpirvModule module() const {
    SpirvModule module{.constant_ids = constant_ids_, .resources = {}};
    for (const Variable& variable : variables_)
      if (const auto resource = resource_of(variable)) module.resources.push_back(*resource);
    return module;
  }

 private:
  struct Variable {
    Id id, type;
    std::uint32_t storage_class;
  };
  struct Array {
    Id element, count;
  };
  static constexpr std::uint32_t k_non_writable = 24;

  void decorate(Words operands) {
    enum { k_spec_id = 1, k_block = 2, k_buffer_block = 3, k_binding = 33 };
    const Id target = operands[0];
    switch (operands[1]) {
      case k_spec_id:
        constant_ids_.push_back(operands[2]);
        break;
      case k_block:
        kinds_[target] = SpirvResource::Kind::uniform_block;
        break;
      case k_buffer_block:
        kinds_[target] = SpirvResource::Kind::storage_block;
        break;
      case k_binding:
        bindings_[target] = operands[2];
        break;
      case k_non_writable:
        non_writable_.insert(target);
        break;
      default:
        break;
    }
  }

  std::optional<SpirvResource> resource_of(const Variable& variable) const {
    const auto binding = bindings_.find(variable.id);
    if (binding == bindings_.end()) return {};
    Id type = variable.type;
    std::uint32_t count = 1;
    for (auto array = arrays_.find(type); array != arrays_.end(); array = arrays_.find(type)) {
      count *= constants_.at(array->second.count);
      type = array->second.element;
    }
    const auto kind = kinds_.find(type);
    if (kind == kinds_.end()) return {};
    SpirvResource resource{kind->second, binding->second, binding->second + count - 1, false};
    // Since SPIR-V 1.3 a storage block is told by its storage class.
    constexpr std::uint32_t k_storage_buffer = 12;
    if (variable.storage_class == k_storage_buffer) resource.kind = SpirvResource::Kind::storage_block;
    resource.is_written = is_written(resource.kind, variable.id, type);
    return resource;
  }

  bool is_written(SpirvResource::Kind kind, Id variable, Id type) const {
    if (kind == SpirvResource::Kind::uniform_block || kind == SpirvResource::Kind::sampler) return false;
    if (non_writable_.contains(variable)) return false;
    if (kind == SpirvResource::Kind::image) return true;
    for (std::uint32_t member = 0; member < member_counts_.at(type); ++member)
      if (!non_writable_members_.contains({type, member})) return true;
    return false;
  }

  std::vector<std::uint32_t> constant_ids_;
  std::vector<Variable> variables_;
  std::map<Id, std::uint32_t> bindings_, constants_;
  std::map<Id, SpirvResource::Kind> kinds_;
  std::map<Id, Array> arrays_;
  std::map<Id, std::size_t> member_counts_;
  std::map<Id, Id> pointees_;
  std::set<Id> non_writable_;
  std::set<std::pair<Id, std::uint32_t>> non_writable_members_;
};

}  // namespace

SpirvModule read_spirv(std::span<const std::uint32_t> words) {
  constexpr std::size_t k_header_words = 5;
  assert(words.size() > k_header_words && words[0] == 0x07230203 &&
         "not SPIR-V of this machine's byte order");
  Declarations declarations;
  for (std::size_t at = k_header_words; at < words.size();) {
    const std::uint32_t length = words[at] >> 16, opcode = words[at] & 0xffff;
    assert(length > 0 && at + length <= words.size());
    declarations.add(opcode, words.subspan(at + 1, length - 1));
    at += length;
  }
  return declarations.module();
}

}  // namespace airlight::gpu
