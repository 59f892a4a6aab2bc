#pragma once

#include <any>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "frame/methods.h"
#include "frame/option.h"
#include "scene/error.h"

namespace airlight::frame {

/// What a method is.
struct Traits {
  bool runs_on_gpu = true;
  bool is_none = false;       ///< leaves out what the others compute
  bool is_truth = false;      ///< what others are judged by, or what goes over into it with more samples
  bool is_exact = false;      ///< right up to rounding, at any resolution
  bool transmits = false;     ///< shows what light passes; else all triangles are opaque to it
  bool is_yardstick = false;  ///< others' times are given as parts of its

  /// Whether an error is asked of it.
  bool is_judged() const { return !is_none && !is_truth; }
};

/// Why a method cannot show a view.
struct Refusal {
  std::string
      where;  ///< the option whose value is to blame, as in integral=table; empty for the whole method
  std::string problem;  ///< "it cannot …"
  std::string remedy;
};

/// A method's description of itself: help, parsing, warnings, results and tables are made from it.
///
/// Made by `describe` from the type of the method's options, which is forgotten here: `options` everywhere
/// below holds that struct.
template <class Interface>
struct Method {
  std::string_view name;
  std::string_view description;  ///< one line
  Traits traits;
  std::vector<Option> options;
  std::any defaults;

  std::function<void*(std::any& options)> address;  ///< for Option::set
  std::function<const void*(const std::any& options)> const_address;

  /// @throws scene::Error (usage) where options contradict each other
  std::function<void(const std::any& options)> validate;
  /// Whether the method can show a view.
  std::function<std::optional<Refusal>(const std::any& options, const scene::View& view)> refusal;
  /// Gives what is automatic its value for a view.
  std::function<void(std::any& options, const scene::View& view)> fit;
  /// Whether it takes the scene's parts for solids: where they are not closed, a warning says so.
  std::function<bool(const std::any& options)> needs_closed_parts;
  /// Whether it takes triangles whole that materials cut parts out of: a warning says so.
  std::function<bool(const std::any& options)> ignores_cut_outs;
  /// Whether it asks for the shadow map (FrameInputs::shadow_map).
  std::function<bool(const std::any& options)> needs_shadow_map;
  std::function<std::unique_ptr<Interface>(const gpu::Context&, const std::any& options)> make;

  const Option* find(std::string_view option_name) const {
    for (const Option& option : options)
      if (option.text.name == option_name) return &option;
    return nullptr;
  }
};

using AirlightMethod = Method<Airlight>;
using SurfaceMethod = Method<SurfaceShadow>;

/// Options of a method that has none.
struct NoOptions {};

/// Makes the description of a method from its words and from the type of its options. Beside its fields
/// `Options` may have
///
///     void validate() const;                                           // throws where fields contradict
///     each other std::optional<Refusal> refusal(const scene::View& view) const;   // else every view can be
///     shown void fit(const scene::View& view);                               // else nothing is automatic
///     bool needs_closed_parts() const;                                 // else not
///     bool ignores_cut_outs() const;                                   // else not
///     bool needs_shadow_map() const;                                   // else not
///
/// @param make std::unique_ptr<Interface>(const gpu::Context&, const Options&)
template <class Interface, class Options, class Make>
Method<Interface> describe(std::string_view name, std::string_view description, const Traits& traits,
                           std::vector<Option> options, const Make& make) {
  Method<Interface> method{
      .name = name,
      .description = description,
      .traits = traits,
      .options = std::move(options),
      .defaults = Options{},
      .address = [](std::any& any) -> void* { return &std::any_cast<Options&>(any); },
      .const_address = [](const std::any& any) -> const void* { return &std::any_cast<const Options&>(any); },
      .validate = [](const std::any&) {},
      .refusal = [](const std::any&, const scene::View&) { return std::nullopt; },
      .fit = [](std::any&, const scene::View&) {},
      .needs_closed_parts = [](const std::any&) { return false; },
      .ignores_cut_outs = [](const std::any&) { return false; },
      .needs_shadow_map = [](const std::any&) { return false; },
      .make = [make](const gpu::Context& context,
                     const std::any& any) { return make(context, std::any_cast<const Options&>(any)); }};
  if constexpr (requires(const Options& o) { o.validate(); })
    method.validate = [](const std::any& any) { std::any_cast<const Options&>(any).validate(); };
  if constexpr (requires(const Options& o, const scene::View& view) { o.refusal(view); })
    method.refusal = [](const std::any& any, const scene::View& view) {
      return std::any_cast<const Options&>(any).refusal(view);
    };
  if constexpr (requires(Options & o, const scene::View& view) { o.fit(view); })
    method.fit = [](std::any& any, const scene::View& view) { std::any_cast<Options&>(any).fit(view); };
  if constexpr (requires(const Options& o) { o.needs_closed_parts(); })
    method.needs_closed_parts = [](const std::any& any) {
      return std::any_cast<const Options&>(any).needs_closed_parts();
    };
  if constexpr (requires(const Options& o) { o.ignores_cut_outs(); })
    method.ignores_cut_outs = [](const std::any& any) {
      return std::any_cast<const Options&>(any).ignores_cut_outs();
    };
  if constexpr (requires(const Options& o) { o.needs_shadow_map(); })
    method.needs_shadow_map = [](const std::any& any) {
      return std::any_cast<const Options&>(any).needs_shadow_map();
    };
  return method;
}

}  // namespace airlight::frame
