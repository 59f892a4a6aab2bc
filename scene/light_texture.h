#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace airlight::scene {

/// What a light radiates in each direction, relative to its radiant intensity: an equirectangular image
/// around it, as it is seen from the light.
///
/// The axes are the world's. As in OpenEXR's latitude-longitude environment maps, +Y is at the top and −Y at
/// the bottom, +Z in the middle, and +X half-way from there to the left edge. With texel centres at
/// half-integers, the direction (x, y, z) of unit length lies at
///
///     column (½ − atan2(x, z) / 2π) · width        row (½ − asin(y) / π) · height
///
/// Between texels the texture is bilinear, around the azimuth too; beyond the centres of the first and the
/// last row it is constant in latitude.
class LightTexture {
 public:
  /// @param name   of the file, as the user wrote it
  /// @param texels RGB without unit, row 0 at the top
  /// @throws Error (bad_file) naming the texel where one is negative or more than 1e6, or where there is none
  LightTexture(std::string name, glm::ivec2 size, std::vector<glm::vec3> texels);

  const std::string& name() const { return name_; }
  glm::ivec2 size() const { return size_; }
  const std::vector<glm::vec3>& texels() const { return texels_; }

 private:
  std::string name_;
  glm::ivec2 size_;
  std::vector<glm::vec3> texels_;
};

}  // namespace airlight::scene
