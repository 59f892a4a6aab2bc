#pragma once

#include "app/options.h"
#include "scene/error.h"

namespace airlight::app {

// The commands. Each throws scene::Error where it cannot do what is asked.

void render(const Options& options);

/// Opens a window on the scene: see viewer::Viewer.
void view(const Options& options);

/// @throws scene::Error (threshold_missed) after everything is written, when --max-error or --max-undecided
/// is missed
void compare(const Options& options);

/// Measures every setting that is asked for and not yet there: see quality::sweep.
void sweep(const Options& options);

/// Finds the least that a scene needs: see quality::tune.
/// @throws scene::Error (threshold_missed) after all is said, where no setting reaches the goal
void tune(const Options& options);

/// Tells what sweeps have measured: see quality::read_fronts.
void front(const Options& options);

/// Joins what `compare` and `sweep` have written in one page: see quality::report_html.
void report(const Options& options);

/// Metrics of images, whoever rendered them: see quality/image_pair.h.
void image(const Options& options);

void list_scenes();

/// Tells what a scene holds, or where none is named the driver and its limits.
void info(const Options& options);

}  // namespace airlight::app
