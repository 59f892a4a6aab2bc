#include "quality/front.h"

#include <filesystem>
#include <vector>

#include "app/commands.h"
#include "app/output.h"
#include "quality/results.h"

namespace airlight::app {

void front(const Options& options) {
  using scene::Error;
  using scene::ExitCode;
  if (options.places.empty())
    throw Error(ExitCode::usage, "DIR", "it is missing", "name a folder that airlight sweep has written");
  const auto json = options.get("json");
  if (json && *json != "-") require_writable(*json);
  const std::vector<std::filesystem::path> places(options.places.begin(), options.places.end());
  const std::vector<quality::Front> fronts =
      quality::read_fronts(places, quality::parse_front_error(options.get("error").value_or("rrmse")));
  if (json && *json != "-") quality::write_text(*json, quality::front_json(fronts));
  print(json == "-" ? quality::front_json(fronts) : quality::front_tables(fronts));
}

}  // namespace airlight::app
