#include "surface_shadows/psv.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

#include "frame/blocks.h"
#include "surface_shadows/transmission.h"
#include "surface_shadows/tree_options.h"

#include "spirv/surface_shadows/psv_insert_comp.h"
#include "spirv/surface_shadows/psv_planes_comp.h"
#include "spirv/surface_shadows/psv_query_frag.h"

namespace airlight::surface_shadows {

std::vector<gpu::Constant> Psv::walk_constants(const frame::SceneBuffers& scene) const {
  return {gpu::Constant(31, options_.wedge == Wedge::on ? 1u : 0u),
          gpu::Constant(32, static_cast<std::uint32_t>(options_.stack)),
          gpu::Constant(33, options_.traversal == Traversal::stackless ? 1u : 0u),
          transmission_constant(scene)};
}

Psv::Psv(const PsvOptions& options)
    : ShadowTree(k_psv_query_frag),
      options_(options),
      occluders_(options.cull),
      planes_program_(gpu::Pipeline::compute(k_psv_planes_comp)),
      insert_program_(gpu::Pipeline::compute(k_psv_insert_comp)) {}

void Psv::load(const frame::FrameInputs& inputs) {
  const std::uint32_t count = inputs.scene.triangle_count();
  const std::int64_t nodes = 4 * std::int64_t{count}, node = sizeof(glm::vec4);
  const gpu::Limits& limits = inputs.context.limits();
  gpu::require_storage_block(limits, node * (nodes + 1), "the tree of the model's triangles",
                             k_storage_remedy);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  if (options_.order == InsertionOrder::random)
    std::shuffle(order.begin(), order.end(), std::mt19937(static_cast<std::uint32_t>(options_.seed)));
  order_ = gpu::Buffer::from(std::span<const std::uint32_t>(order));
  planes_ = gpu::Buffer(node * nodes);
  links_ = gpu::Buffer(node * (nodes + 1));
  subtrees_ = gpu::Buffer(std::int64_t{2 * sizeof(std::uint32_t)} * count);
  order_texels_ = {limits, order_, gpu::Format::r32ui, "the model's triangles"};
  plane_texels_ = {limits, planes_, gpu::Format::rgba32f, "the tree of the model's triangles"};
  link_texels_ = {limits, links_, gpu::Format::rgba32ui, "the tree of the model's triangles"};
  subtree_texels_ = {limits, subtrees_, gpu::Format::r32ui, "the tree of the model's triangles"};
  scene_ = inputs.scene.id();
}

void Psv::build(const frame::FrameInputs& inputs) {
  inputs.triangle_planes();  // a stage of its own
  inputs.timer.time("surface_build", [&] {
    if (scene_ != inputs.scene.id()) load(inputs);
    const std::uint32_t count = inputs.scene.triangle_count();
    occluders_.build(inputs);
    if (count == 0) return;
    occluders_.bind(inputs);
    planes_.bind_storage(shaders::k_tree_planes_storage);
    links_.bind_storage(shaders::k_tree_links_storage);
    planes_program_.set(0, count);
    planes_program_.set(1, occluders_.reach());
    subtrees_.bind_storage(shaders::k_subtrees_storage);
    planes_program_.dispatch({count, 1, 1});

    order_texels_.bind_sampler(shaders::k_insertion_order_unit);
    plane_texels_.bind_sampler(shaders::k_tree_planes_unit);
    insert_program_.set(0, count);
    insert_program_.set(1, occluders_.reach());
    insert_program_.dispatch({count, 1, 1});
  });
}

void Psv::bind_walk(const frame::FrameInputs& inputs, const gpu::Pipeline& pipeline) const {
  occluders_.bind(inputs);
  plane_texels_.bind_sampler(shaders::k_tree_planes_unit);
  link_texels_.bind_sampler(shaders::k_tree_links_unit);
  subtree_texels_.bind_sampler(shaders::k_subtrees_unit);
  pipeline.set(1, occluders_.scale());
  pipeline.set(2, occluders_.reach());
}

std::map<std::string, double> Psv::counters(const frame::FrameInputs& inputs) {
  return {{"surface_nodes", total(inputs, Counted::nodes)}};
}

std::map<std::string, std::int64_t> Psv::bytes() const {
  return {{"occluders", occluders_.bytes()},
          {"tree", planes_.bytes() + links_.bytes() + subtrees_.bytes() + order_.bytes()}};
}

frame::SurfaceMethod psv_method() {
  using Options = PsvOptions;
  return frame::describe<frame::SurfaceShadow, Options>(
      "psv", "partitioned shadow volumes: a ternary tree over the triangles' shadows, exact",
      {.is_exact = true, .transmits = true},
      {culling_option(&Options::cull),
       frame::word_option<Options, Wedge>(
           {.name = "wedge",
            .meaning = "whether what a plane intersects is left out where the point is far from the plane",
            .quality = "none",
            .cost = "off visits several times the nodes",
            .sweep = {"on", "off"}},
           {{"on", "bounded by its angle with the plane"}, {"off", "always visited"}}, &Options::wedge),
       frame::word_option<Options, InsertionOrder>(
           {.name = "order",
            .meaning = "in which order triangles are inserted",
            .quality = "none",
            .cost = "neighbours in a row make a deep tree",
            .sweep = {"random", "file"}},
           {{"random", "shuffled once a scene"},
            {"file", "as neighbours follow each other in the scene's buffers"}},
           &Options::order),
       seed_option(&Options::seed),
       frame::word_option<Options, Traversal>(
           {.name = "traversal",
            .meaning = "how a pixel finds back to nodes that it left for later",
            .quality = "none",
            .cost = "stackless visits nodes several times, with few registers",
            .sweep = {"stack", "stackless"}},
           {{"stack", "by a stack, and where it overflows without"},
            {"stackless", "by the tree itself, each node decided anew"}},
           &Options::traversal),
       stack_option(&Options::stack)},
      [](const gpu::Context&, const Options& options) { return std::make_unique<Psv>(options); });
}

}  // namespace airlight::surface_shadows
