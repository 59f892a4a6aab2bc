#pragma once

#include <any>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frame/method.h"
#include "quality/traced.h"

namespace airlight::quality {

using VolumeMethod = frame::AirlightMethod;
using SurfaceMethod = frame::SurfaceMethod;

/// All methods, in the order of tables. A new method is one line in methods.cpp.
std::span<const VolumeMethod> volume_methods();
std::span<const SurfaceMethod> surface_methods();

/// An option of the command that is meant for every method that has it.
struct CommonOption {
  std::string where;  ///< as the user wrote it, such as --alpha
  std::string name;   ///< of the methods' option
  std::string value;
};

/// What the command offers for all methods at once: the first method's option of each such name.
struct CommonOptionText {
  std::string_view name;
  std::string help;
};
std::vector<CommonOptionText> common_option_texts();

/// @throws scene::Error (usage) where no method's option of that name takes the value
void require_valid(const CommonOption& common);

/// A method with its options, as asked for by METHOD:key=value:key=value.
template <typename MethodType>
struct Choice {
  std::string spec;  ///< as the user wrote it
  const MethodType* method;
  std::any options;  ///< of the method

  /// The options by name.
  std::map<std::string, frame::OptionValue> values() const {
    std::map<std::string, frame::OptionValue> values;
    for (const frame::Option& option : method->options)
      values[std::string(option.text.name)] = option.get(method->const_address(options));
    return values;
  }

  /// The method and all of its options, a line each.
  std::string words() const;

  /// Fits the options to a view. @throws scene::Error (usage) where the method cannot show it
  void fit(const scene::View& view) {
    if (const auto refusal = method->refusal(options, view)) throw refusal_error(*refusal);
    method->fit(options, view);
  }

  /// Fits the options to all of the views: of counts that are automatic, the largest.
  /// @throws scene::Error (usage) as for one view, naming the frame, and where a word would have to change
  /// from view to view
  void fit(std::span<const scene::View> views);

  /// The choice with another value of an option.
  /// @throws scene::Error (usage) for a value that the option does not take, and where it contradicts another
  Choice with(const frame::Option& option, std::string_view value) const {
    Choice other = *this;
    option.set(method->address(other.options), std::string(option.text.name), value);
    method->validate(other.options);
    return other;
  }

  /// @param reference lent to methods of the CPU
  auto make(const gpu::Context& context, SharedReference& reference) const {
    auto made = method->make(context, options);
    lend(reference, *made);
    return made;
  }

 private:
  scene::Error refusal_error(const frame::Refusal& refusal) const;
};

using VolumeChoice = Choice<VolumeMethod>;
using SurfaceChoice = Choice<SurfaceMethod>;

/// Reads a comma-separated list of specs; their own keys override `common`.
/// @throws scene::Error (usage) for an unknown method, key or value, naming it and the valid ones; for a spec
/// given twice; for keys that contradict each other.
std::vector<VolumeChoice> parse_volumes(std::string_view list, std::span<const CommonOption> common = {});
std::vector<SurfaceChoice> parse_surfaces(std::string_view list, std::span<const CommonOption> common = {});

/// Methods and options as the README shows them.
std::string method_tables();

/// One method a line, its options below, as the help shows them.
std::string method_help();

/// Whether one of the methods looks at an option of the command that is meant for all methods at once: a
/// common one, or `shadow-map`.
/// @param name without dashes; every other option counts as looked at
bool is_read(std::string_view name, std::span<const VolumeChoice> volumes,
             std::span<const SurfaceChoice> surfaces);

/// @throws scene::Error (usage) for an option that none of the methods looks at, naming those that would
/// @param given names of the options that the user gave, without dashes
void require_read(std::span<const std::string> given, std::span<const VolumeChoice> volumes,
                  std::span<const SurfaceChoice> surfaces);

/// Adds a warning to the scene's report where a method takes its parts for solids and they are not closed,
/// where one takes triangles whole that are cut out, and where one takes them for opaque that light passes.
/// @throws scene::Error (usage) for airlight of an x-ray view (scene::Transmission)
void warn_of_geometry(std::span<const VolumeChoice> volumes, std::span<const SurfaceChoice> surfaces,
                      scene::Scene& scene);

}  // namespace airlight::quality
