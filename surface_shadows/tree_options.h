#pragma once

#include "frame/option.h"

/// What the trees of surface shadows, made by insertion and asked once a pixel, have to choose alike.
namespace airlight::surface_shadows {

template <class Options>
frame::Option seed_option(int Options::*field) {
  return frame::count_option<Options>({.name = "seed",
                                       .meaning = "of the random order",
                                       .quality = "none",
                                       .cost = "a few percent, by chance",
                                       .sweep = {"1", "2", "3"}},
                                      {.least = 0}, field);
}

template <class Options>
frame::Option stack_option(int Options::*field) {
  return frame::count_option<Options>(
      {.name = "stack",
       .meaning = "nodes that the stack holds",
       .quality = "none",
       .cost = "registers, or the way without a stack for pixels that need more",
       .sweep = {"24", "32", "64"}},
      {.least = 1, .most = 128}, field);
}

}  // namespace airlight::surface_shadows
