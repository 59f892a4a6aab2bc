#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstdint>
#include <numeric>

#include <fmt/format.h>

#include "reference/fan.h"
#include "reference/fog_quadrature.h"
#include "reference/light_shape.h"
#include "reference/phase.h"
#include "reference/reference.h"
#include "reference/shadowable.h"
#include "reference/state.h"
#include "reference/sun_steps.h"
#include "scene/error.h"
#include "scene/parallel.h"

// The airlight by brute force: a shadow ray at every step along every view ray.
//
// Based on: Chris Wyman, Voxelized Shadow Volumes, HPG 2011, section 5, whose ray-traced comparison this is.
// It deviates in the extinction of the light's own path, which is included, and in steps that are uniform in
// φ instead of in t. And steps that a narrow lobe of the phase function is not smooth over, which no sum of
// values at their middles would see, count with their integral: what is sampled is the visibility alone. So
// it is under a sun, where the integral is known in closed form.

namespace airlight::reference {

namespace {

/// e^{x} for x ≤ 0, relative error below 3e-7; below −87, e^{−87} (1.6e-38). A loop over lanes turns into
/// vector code.
inline float exp_of_nonpositive(float x) {
  x = std::max(x, -87.0f);
  // Adding and taking away 1.5·2²³ rounds to an integer.
  constexpr float k_round = 12582912.0f;
  const float rounded = x * 1.44269504f + k_round;
  const float exponent = rounded - k_round;
  // ln 2 in two parts, so that the difference keeps its digits (Cody and Waite).
  const float y = (x - exponent * 0.693359375f) + exponent * 2.12194440e-4f;
  // Taylor's series on |y| ≤ ln 2 / 2.
  const float e =
      1.0f + y * (1.0f + y * (0.5f + y * (1.0f / 6 + y * (1.0f / 24 + y * (1.0f / 120 + y * (1.0f / 720))))));
  const auto power = (std::bit_cast<std::int32_t>(rounded) - std::bit_cast<std::int32_t>(k_round) + 127)
                     << 23;
  return e * std::bit_cast<float>(power);
}

/// Sums the integrand e^{−σ(a+b)} p(α+φ) (fog_quadrature.cpp) over the lit samples of a fan.
/// @param sigma_t extinction coefficient σ of one channel [1/m]
/// @param lobe    integrates the steps that it is not smooth over
/// @param step    of φ [rad]
/// @param shares  of the light's intensity that its texture, cone and range leave, of that channel, for each
///                sample; nullptr where that is all of it
double sum_lit(const ViewRay& ray, const HalfAngles& half, std::uint32_t lit, double sigma_t,
               const scene::Medium& medium, const FogQuadrature& lobe, double step, const float* shares) {
  constexpr int k_count = LightRays::k_count;
  const double scale = sigma_t * ray.D * ray.sin_alpha;
  const double offset = sigma_t * (ray.D * ray.cos_alpha - ray.from);
  alignas(64) float depth[k_count], value[k_count];
  for (int i = 0; i < k_count; ++i)
    depth[i] = static_cast<float>(offset + scale * (half.cosine[i] / half.sine[i]));  // view_ray.h (3)
  if (ray.light_height > 0.0) {
    // The path above the layer (fog_quadrature.cpp), from the whole in double precision.
    for (int i = 0; i < k_count; ++i) {
      const double cosine = half.cosine[i] * half.cosine[i] - half.sine[i] * half.sine[i];
      const double sine = 2.0 * half.cosine[i] * half.sine[i];
      const double descent =
          std::max(-(ray.w.y * cosine + ray.q.y * sine), ray.light_height * sine / (ray.D * ray.sin_alpha));
      depth[i] = static_cast<float>(offset + scale * (half.cosine[i] / half.sine[i]) -
                                    sigma_t * ray.light_height / descent);
    }
  }
  for (int i = 0; i < k_count; ++i) value[i] = (lit >> i & 1u) ? exp_of_nonpositive(-depth[i]) : 0.0f;
  if (medium.phase != scene::PhaseFunction::isotropic) {
    for (int i = 0; i < k_count; ++i) {
      const double cosine = half.sine[i] * half.sine[i] - half.cosine[i] * half.cosine[i];  // view_ray.h (4)
      value[i] *= static_cast<float>(phase(medium, cosine));
    }
    if (lobe.has_narrow_lobe()) {
      for (int i = 0; i < k_count; ++i) {
        const double psi = 2.0 * std::atan2(half.sine[i], half.cosine[i]);
        if ((lit >> i & 1u) && !lobe.lobe_is_smooth(psi, step))
          value[i] = static_cast<float>(lobe.integral(psi + 0.5 * step, psi - 0.5 * step).r / step);
      }
    }
  }
  if (shares) {
    for (int i = 0; i < k_count; ++i) value[i] *= shares[i];
  }
  double sum = 0.0;
  for (int i = 0; i < k_count; ++i) sum += static_cast<double>(value[i]);
  return medium.phase == scene::PhaseFunction::isotropic ? sum * phase(medium, 0.0) : sum;
}

/// What a light sends along each of its rays, relative to its intensity, by channel.
struct LightShares {
  float values[3][LightRays::k_count];
};

/// @param texture, shape the light's; no texture is nullptr
LightShares look_up(const LightLookup* texture, const LightShape& shape, const LightRays& rays,
                    const HalfAngles& half, std::uint32_t lit) {
  LightShares shares{};
  for (int i = 0; i < LightRays::k_count; ++i) {
    if (!(lit >> i & 1u)) continue;
    const glm::dvec3 direction(rays.direction_x[i], rays.direction_y[i], rays.direction_z[i]);
    glm::vec3 share(1.0f);
    if (texture) share = texture->at(direction);
    share *= static_cast<float>(shape.at(2.0 * std::atan2(half.sine[i], half.cosine[i])));
    for (int channel = 0; channel < 3; ++channel) shares.values[channel][i] = share[channel];
  }
  return shares;
}

}  // namespace

AirlightImage Reference::march(int samples, RayMode mode, const Progress& progress) const {
  if (samples < 1) {
    throw scene::Error(scene::ExitCode::usage, "reference samples",
                       fmt::format("{} is not at least 1", samples));
  }
  return state_->sun ? march_to_sun(samples, mode, progress) : march_to_point(samples, mode, progress);
}

AirlightImage Reference::march_to_sun(int samples, RayMode mode, const Progress& progress) const {
  const State& state = *state_;
  AirlightImage image;
  image.radiance.resize(state.pixels());
  std::atomic<std::uint64_t> marched{0};  // view rays
  const auto start = std::chrono::steady_clock::now();

  const auto make_worker = [&] {
    return [&, shadowable = Shadowable(state.box, state.camera.eye, state.sun),
            integrals = state.run_integrals()](int y) mutable {
      SunwardRays rays;
      for (int x = 0; x < state.view.size.x; ++x) {
        const SunRay ray = state.ray<SunRay>(x, y);
        const SunRay part = shadowable.part_of(ray);
        const bool is_empty = part.from == part.to;
        if (!is_empty) ++marched;
        const auto [radiance] = integrals.radiances<1>(ray, [&](const auto& add) {
          Shadowable::for_each_rest(ray, part, [&](double from, double to) { add(0, from, to, 1.0); });
          if (is_empty) return;
          SunSteps steps(part, samples, 0.5);
          int lit_from = 0, step = 0;  // steps from the one to the other are lit
          const auto add_lit = [&] {
            if (lit_from < step)
              add(0, part.t(static_cast<double>(lit_from) / samples),
                  part.t(static_cast<double>(step) / samples), 1.0);
          };
          while (step < samples) {
            aim(part, steps.places(), rays);
            const int count = std::min(SunwardRays::k_count, samples - step);
            const std::uint32_t lit = state.visibility.lit(rays, count, mode);
            for (int i = 0; i < count; ++i, ++step) {
              if (lit >> i & 1u) continue;
              add_lit();
              lit_from = step + 1;
            }
            steps.advance();
          }
          add_lit();
        });
        image.radiance[state.index(x, y)] = glm::vec3(radiance);
      }
    };
  };
  scene::parallel(state.view.size.y, make_worker, progress);

  image.rays = marched * static_cast<std::uint64_t>(samples);
  image.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return image;
}

AirlightImage Reference::march_to_point(int samples, RayMode mode, const Progress& progress) const {
  const State& state = *state_;
  const scene::Medium& medium = state.view.medium;
  const glm::dvec3 sigma_t = glm::dvec3(medium.sigma_s) + glm::dvec3(medium.sigma_a);
  const bool grey = sigma_t.r == sigma_t.g && sigma_t.g == sigma_t.b && !state.light_texture;
  const bool is_uneven = state.light_texture || LightShape(state.light).is_shaped();

  AirlightImage image;
  image.radiance.resize(state.pixels());
  std::atomic<std::uint64_t> marched{0};  // view rays
  const auto start = std::chrono::steady_clock::now();

  const auto make_worker = [&] {
    return [&, shape = LightShape(state.light)](int y) mutable {
      LightRays rays;
      for (int x = 0; x < state.view.size.x; ++x) {
        const ViewRay ray = state.ray<ViewRay>(x, y);
        if (ray.phi_d == 0.0) continue;  // none of it lies in the medium
        ++marched;
        if (is_uneven) shape.aim(ray);
        const double step = ray.phi_d / samples;
        const std::array quadrature = {FogQuadrature(ray, sigma_t.r, medium),
                                       FogQuadrature(ray, sigma_t.g, medium),
                                       FogQuadrature(ray, sigma_t.b, medium)};
        glm::dvec3 sum(0.0);
        Fan fan(ray, samples, 0.5);
        for (int first = 0; first < samples; first += LightRays::k_count) {
          aim(ray, fan.places(), rays);
          const int count = std::min(LightRays::k_count, samples - first);
          const std::uint32_t lit = state.visibility.lit(rays, count, mode);
          if (lit != 0) {
            LightShares shares;
            if (is_uneven)
              shares = look_up(state.light_texture ? &*state.light_texture : nullptr, shape, rays,
                               fan.places(), lit);
            for (int channel = 0; channel < (grey ? 1 : 3); ++channel) {
              sum[channel] += sum_lit(ray, fan.places(), lit, sigma_t[channel], medium, quadrature[channel],
                                      step, is_uneven ? shares.values[channel] : nullptr);
            }
          }
          fan.advance();
        }
        if (grey) sum = glm::dvec3(sum.r);
        // docs/method.md (*), the integral as a Riemann sum.
        image.radiance[state.index(x, y)] = glm::vec3(airlight_scale(ray, state.light, medium) * step * sum);
      }
    };
  };
  scene::parallel(state.view.size.y, make_worker, progress);

  image.rays = marched * static_cast<std::uint64_t>(samples);
  image.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  return image;
}

}  // namespace airlight::reference
