#include "quality/methods.h"

#include <algorithm>

#include <fmt/format.h>

#include "epipolar/surface_lookup.h"
#include "frame/none.h"
#include "media/froxel.h"
#include "media/march.h"
#include "media/vsv.h"
#include "scene/components.h"
#include "scene/error.h"
#include "scene/numbers.h"
#include "scene/transmission.h"
#include "surface_shadows/brute.h"
#include "surface_shadows/metric_tree.h"
#include "surface_shadows/psv.h"
#include "surface_shadows/shadow_map_lookup.h"

namespace airlight::quality {

using scene::Error;
using scene::ExitCode;
using scene::split;

std::span<const VolumeMethod> volume_methods() {
  static const std::vector<VolumeMethod> methods = {
      frame::no_airlight_method(), media::vsv_method(),      media::march_method(),
      media::tree_march_method(),  media::froxel_method(),   reference_method(),
      reference_sampled_method(),  reference_march_method(),
  };
  return methods;
}

std::span<const SurfaceMethod> surface_methods() {
  static const std::vector<SurfaceMethod> methods = {
      frame::no_shadow_method(),     surface_shadows::shadow_map_method(),  epipolar::surface_lookup_method(),
      surface_shadows::psv_method(), surface_shadows::metric_tree_method(), surface_shadows::brute_method(),
      reference_surface_method(),
  };
  return methods;
}

namespace {

/// Calls f(method, option) for every option of every method.
template <typename Function>
void for_each_option(const Function& f) {
  const auto visit = [&](const auto& methods) {
    for (const auto& method : methods)
      for (const frame::Option& option : method.options) f(method, option);
  };
  visit(volume_methods());
  visit(surface_methods());
}

template <typename Range, typename Name>
std::string join_names(const Range& things, const Name& name_of) {
  std::string names;
  for (const auto& thing : things) names += fmt::format("{}{}", names.empty() ? "" : ", ", name_of(thing));
  return names;
}

/// Reads one spec.
/// @param option such as --volume
template <typename MethodType>
Choice<MethodType> parse_choice(const std::string& option, std::string_view spec,
                                std::span<const CommonOption> common, std::span<const MethodType> methods) {
  const std::vector<std::string_view> parts = split(spec, ':');
  const auto method =
      std::find_if(methods.begin(), methods.end(), [&](const MethodType& m) { return m.name == parts[0]; });
  if (method == methods.end()) {
    throw Error(ExitCode::usage, option, fmt::format("there is no method '{}'", parts[0]),
                "use " + join_names(methods, [](const MethodType& m) { return m.name; }));
  }

  Choice<MethodType> choice{std::string(spec), &*method, method->defaults};
  for (const CommonOption& given : common) {
    const frame::Option* known = method->find(given.name);
    if (known && known->text.is_common) known->set(method->address(choice.options), given.where, given.value);
  }
  const std::string where = fmt::format("{} {}", option, spec);
  for (std::string_view part : std::span(parts).subspan(1)) {
    const std::size_t equals = part.find('=');
    const std::string_view name = part.substr(0, equals);
    const frame::Option* known = method->find(name);
    if (!known) {
      const auto name_of = [](const frame::Option& o) { return o.text.name; };
      throw Error(ExitCode::usage, where, fmt::format("{} has no key '{}'", method->name, name),
                  method->options.empty() ? "it has none" : "use " + join_names(method->options, name_of));
    }
    if (equals == std::string_view::npos) {
      throw Error(ExitCode::usage, where, fmt::format("the key '{}' has no value", name),
                  fmt::format("write {}=VALUE: {}", name,
                              frame::help_text(*known, method->const_address(method->defaults))));
    }
    known->set(method->address(choice.options), fmt::format("{}, {}", where, name), part.substr(equals + 1));
  }
  method->validate(choice.options);
  return choice;
}

template <typename MethodType>
std::vector<Choice<MethodType>> parse_choices(const std::string& option, std::string_view list,
                                              std::span<const CommonOption> common,
                                              std::span<const MethodType> methods) {
  std::vector<Choice<MethodType>> choices;
  for (std::string_view spec : split(list, ',')) {
    Choice<MethodType> choice = parse_choice(option, spec, common, methods);
    if (std::any_of(choices.begin(), choices.end(), [&](const auto& c) { return c.spec == spec; })) {
      throw Error(ExitCode::usage, option, fmt::format("{} is there twice", spec), "name each method once");
    }
    choices.push_back(std::move(choice));
  }
  return choices;
}

}  // namespace

std::vector<CommonOptionText> common_option_texts() {
  std::vector<CommonOptionText> texts;
  for_each_option([&](const auto& method, const frame::Option& option) {
    const bool is_there = std::any_of(texts.begin(), texts.end(),
                                      [&](const auto& text) { return text.name == option.text.name; });
    if (option.text.is_common && !is_there)
      texts.push_back({option.text.name, frame::help_text(option, method.const_address(method.defaults))});
  });
  return texts;
}

void require_valid(const CommonOption& common) {
  for_each_option([&](const auto& method, const frame::Option& option) {
    if (option.text.name != common.name) return;
    std::any options = method.defaults;
    option.set(method.address(options), common.where, common.value);
  });
}

template <typename MethodType>
Error Choice<MethodType>::refusal_error(const frame::Refusal& refusal) const {
  return Error(ExitCode::usage,
               refusal.where.empty() ? spec : fmt::format("{}:{}", method->name, refusal.where),
               refusal.problem, refusal.remedy);
}

template <typename MethodType>
std::string Choice<MethodType>::words() const {
  std::string words = fmt::format("{}\n", method->name);
  for (const auto& [name, value] : values()) words += fmt::format(" {}={}\n", name, frame::text_of(value));
  return words;
}

template <typename MethodType>
void Choice<MethodType>::fit(std::span<const scene::View> views) {
  if (views.size() == 1) return fit(views[0]);
  const std::any given = options;
  for (std::size_t frame = 0; frame < views.size(); ++frame) {
    Choice fitted{spec, method, given};
    try {
      fitted.fit(views[frame]);
    } catch (const Error& error) {
      throw Error(error.exit_code, fmt::format("--path, frame {}", frame), error.what());
    }
    if (frame == 0) options = fitted.options;
    for (const frame::Option& option : method->options) {
      const frame::OptionValue value = option.get(method->const_address(fitted.options)),
                               so_far = option.get(method->const_address(options));
      if (value == so_far) continue;
      const std::string where = fmt::format("{}, {}", spec, option.text.name);
      const int *count = std::get_if<int>(&value), *count_so_far = std::get_if<int>(&so_far);
      if (!count || !count_so_far)
        throw Error(ExitCode::usage, where,
                    fmt::format("it would be {} in the path's frame {} and {} before", frame::text_of(value),
                                frame, frame::text_of(so_far)),
                    "choose one for all frames");
      if (*count > *count_so_far) option.set(method->address(options), where, fmt::format("{}", *count));
    }
  }
}

template struct Choice<VolumeMethod>;
template struct Choice<SurfaceMethod>;

std::vector<VolumeChoice> parse_volumes(std::string_view list, std::span<const CommonOption> common) {
  return parse_choices("--volume", list, common, volume_methods());
}

std::vector<SurfaceChoice> parse_surfaces(std::string_view list, std::span<const CommonOption> common) {
  return parse_choices("--surface", list, common, surface_methods());
}

namespace {

/// Which values an option takes in a table, its default first.
std::string values_cell(const frame::Option& option, const std::string& usual) {
  const auto* words = std::get_if<frame::Words>(&option.values);
  if (!words) return fmt::format("`{}`; {}", usual, frame::values_text(option));
  std::string first, others;
  for (const frame::Word& word : *words) {
    const std::string entry =
        fmt::format("`{}`{}{}", word.word, word.meaning.empty() ? "" : ": ", word.meaning);
    if (word.word == usual)
      first = entry;
    else
      others += "; " + entry;
  }
  return first + others;
}

/// Whether the tables of volume methods tell a surface method's options, for the one that is named alike.
bool is_told(const SurfaceMethod& surface) {
  return std::any_of(volume_methods().begin(), volume_methods().end(), [&](const VolumeMethod& volume) {
    return volume.name == surface.name &&
           std::all_of(surface.options.begin(), surface.options.end(),
                       [&](const frame::Option& option) { return volume.find(option.text.name) != nullptr; });
  });
}
bool is_told(const VolumeMethod&) {
  return false;
}

template <typename MethodType>
std::string tables_of(std::string_view title, std::span<const MethodType> methods) {
  std::string table = fmt::format("| {} | what it is |\n|---|---|\n", title);
  for (const MethodType& method : methods) {
    table += fmt::format("| `{}` | {}", method.name, method.description);
    if (!method.options.empty() && is_told(method)) {
      const auto name_of = [](const frame::Option& option) { return fmt::format("`{}`", option.text.name); };
      table += "; of the keys above it has " + join_names(method.options, name_of);
    }
    table += " |\n";
  }
  for (const MethodType& method : methods) {
    if (method.options.empty() || is_told(method)) continue;
    table += fmt::format("\n| key of `{}` | what it sets | values, the default first | quality | cost |\n",
                         method.name);
    table += "|---|---|---|---|---|\n";
    for (const frame::Option& option : method.options) {
      const std::string usual = frame::text_of(option.get(method.const_address(method.defaults)));
      table += fmt::format("| `{}` | {} | {} | {} | {} |\n", option.text.name, option.text.meaning,
                           values_cell(option, usual), option.text.quality, option.text.cost);
    }
  }
  return table;
}

template <typename MethodType>
std::string help_of(std::span<const MethodType> methods) {
  std::string help;
  for (const MethodType& method : methods) {
    help += fmt::format("  {:<16} {}\n", method.name, method.description);
    for (const frame::Option& option : method.options)
      help += fmt::format("    {:<14} {}\n", option.text.name,
                          frame::help_text(option, method.const_address(method.defaults)));
  }
  return help;
}

}  // namespace

std::string method_tables() {
  return tables_of("volume method", volume_methods()) + "\n" + tables_of("surface method", surface_methods());
}

std::string method_help() {
  return "METHOD is NAME:key=value:key=value. Airlight, with its keys:\n" + help_of(volume_methods()) +
         "Surface shadow:\n" + help_of(surface_methods());
}

namespace {

/// Whether a method with these options looks at that option, of those that are meant for all methods.
template <typename MethodType>
bool reads(const MethodType& method, const std::any& options, std::string_view name) {
  if (name == "shadow-map") return method.needs_shadow_map(options);
  const frame::Option* option = method.find(name);
  return option && option->text.is_common;
}

bool is_for_methods(std::string_view name) {
  const auto texts = common_option_texts();
  return name == "shadow-map" || std::any_of(texts.begin(), texts.end(),
                                             [&](const CommonOptionText& text) { return text.name == name; });
}

}  // namespace

bool is_read(std::string_view name, std::span<const VolumeChoice> volumes,
             std::span<const SurfaceChoice> surfaces) {
  const auto is_reader = [&](const auto& choice) { return reads(*choice.method, choice.options, name); };
  return !is_for_methods(name) || std::any_of(volumes.begin(), volumes.end(), is_reader) ||
         std::any_of(surfaces.begin(), surfaces.end(), is_reader);
}

void require_read(std::span<const std::string> given, std::span<const VolumeChoice> volumes,
                  std::span<const SurfaceChoice> surfaces) {
  for (const std::string& name : given) {
    if (is_read(name, volumes, surfaces)) continue;
    std::string chosen, readers;
    const auto add = [](std::string& list, std::string_view option, std::string_view method) {
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", option, method);
    };
    for (const VolumeChoice& choice : volumes) add(chosen, "--volume", choice.spec);
    for (const SurfaceChoice& choice : surfaces) add(chosen, "--surface", choice.spec);
    for (const VolumeMethod& method : volume_methods())
      if (reads(method, method.defaults, name)) add(readers, "--volume", method.name);
    for (const SurfaceMethod& method : surface_methods())
      if (reads(method, method.defaults, name)) add(readers, "--surface", method.name);
    throw Error(ExitCode::usage, fmt::format("--{}", name),
                fmt::format("none of the methods chosen reads it ({})", chosen),
                fmt::format("leave it out, or choose one that does: {}", readers));
  }
}

namespace {

/// The specs of those that have a property, with commas between.
template <typename Property>
std::string specs_with(std::span<const VolumeChoice> volumes, std::span<const SurfaceChoice> surfaces,
                       const Property& property) {
  std::string specs;
  const auto note = [&](const auto& choice) {
    if (property(choice)) specs += fmt::format("{}{}", specs.empty() ? "" : ", ", choice.spec);
  };
  std::for_each(volumes.begin(), volumes.end(), note);
  std::for_each(surfaces.begin(), surfaces.end(), note);
  return specs;
}

/// @throws Error (usage) where airlight is asked for of what no truth of airlight knows
void require_airlight(std::span<const VolumeChoice> volumes, const scene::Geometry& geometry) {
  if (!scene::transmits_by_incidence(geometry)) return;
  for (const VolumeChoice& choice : volumes)
    if (!choice.method->traits.is_none)
      throw Error(ExitCode::usage, fmt::format("--volume {}", choice.spec),
                  "what light passes by its angle of incidence is shown on surfaces alone",
                  "ask for --volume none, or for --occluders material or opaque");
}

}  // namespace

void warn_of_geometry(std::span<const VolumeChoice> volumes, std::span<const SurfaceChoice> surfaces,
                      scene::Scene& scene) {
  if (const std::string who =
          specs_with(volumes, surfaces,
                     [](const auto& choice) { return choice.method->ignores_cut_outs(choice.options); });
      !who.empty() && scene::has_cut_outs(scene.geometry))
    scene.report.warnings.push_back(fmt::format(
        "{} cannot show what materials cut out of their triangles: the shadows are those of whole "
        "triangles",
        who));

  require_airlight(volumes, scene.geometry);
  if (const std::string who = specs_with(volumes, surfaces,
                                         [](const auto& choice) {
                                           const frame::Traits& traits = choice.method->traits;
                                           return !traits.is_none && !traits.transmits;
                                         });
      !who.empty() && scene::transmits(scene.geometry))
    scene.report.warnings.push_back(fmt::format(
        "{} cannot show what light passes: all triangles are opaque there, and it is judged by such a truth",
        who));

  const std::string who = specs_with(volumes, surfaces, [](const auto& choice) {
    return choice.method->needs_closed_parts(choice.options);
  });
  if (who.empty()) return;
  const scene::Components components =
      scene::find_components(scene.geometry, scene::find_edges(scene.geometry));
  if (components.is_watertight()) return;
  scene.report.warnings.push_back(
      fmt::format("{} fills the inside of watertight parts, and will show shadow and light where there is "
                  "none: {}",
                  who, scene::describe_gaps(components)));
}

}  // namespace airlight::quality
