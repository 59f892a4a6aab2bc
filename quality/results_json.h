#pragma once

#include <nlohmann/json_fwd.hpp>

#include "quality/results.h"
#include "quality/statistics.h"

/// What of results.json other files have too.
namespace airlight::quality {

/// A finite number; null where it is none, as against a dark reference.
nlohmann::ordered_json number_json(double value);

nlohmann::ordered_json interval_json(const MedianInterval& interval);

/// Of `error` of a run: "airlight" and "airlight_same_surface".
nlohmann::ordered_json airlight_json(const AirlightError& error, double flip);
nlohmann::ordered_json same_surface_json(const SameSurfaceError& error);

nlohmann::ordered_json device_json(const gpu::Device& device, unsigned cores);

/// A run, as in results.json.
nlohmann::ordered_json run_json(const Run& run, const scene::View& view);

/// On one line or, with an indentation, several. File names need not be UTF-8; JSON must be.
std::string text_of_json(const nlohmann::ordered_json& json, int indentation = -1);

}  // namespace airlight::quality
