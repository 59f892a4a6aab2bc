#include "scene/coplanar.h"

#include <array>
#include <bit>
#include <cstddef>

namespace airlight::scene {
namespace {

/// An integer modulo a prime.
///
/// The prime is the first one p after π · 2^61 for which (p − 1) / 2 is prime too. Any such number would do
/// that is far from a sum of a few powers of 2: modulo 2^61 − 1, which would be quicker, the floats 1 and
/// 2^-61 are the same, and planes at such heights one. Modulo this prime no two floats are the same: there
/// are no integers |a|, |b| < 2^24 with 2^k a ≡ b, k up to 253, but those with 2^k a = b.
class Residue {
 public:
  constexpr Residue() = default;
  constexpr explicit Residue(std::uint64_t integer) : value_(integer % k_prime) {}

  constexpr std::uint64_t value() const { return value_; }

  friend constexpr bool operator==(Residue, Residue) = default;
  friend constexpr Residue operator+(Residue a, Residue b) { return less(a.value_ + b.value_); }
  friend constexpr Residue operator-(Residue a, Residue b) { return less(a.value_ + (k_prime - b.value_)); }
  friend constexpr Residue operator*(Residue a, Residue b) {
    return less(static_cast<std::uint64_t>(static_cast<Wide>(a.value_) * b.value_ % k_prime));
  }

  /// 1 / a, by Fermat.
  friend constexpr Residue inverse(Residue a) {
    Residue result(1);
    for (std::uint64_t exponent = k_prime - 2; exponent != 0; exponent /= 2) {
      if (exponent % 2 == 1) result = result * a;
      a = a * a;
    }
    return result;
  }

 private:
  using Wide = unsigned __int128;
  static constexpr std::uint64_t k_prime = 0x6487ed5110b46273;

  /// @param value below twice the prime
  static constexpr Residue less(std::uint64_t value) {
    Residue result;
    result.value_ = value < k_prime ? value : value - k_prime;
    return result;
  }

  std::uint64_t value_ = 0;
};

/// 2^0, 2^1, …: as many as floats have exponents.
constexpr auto k_powers_of_2 = [] {
  std::array<Residue, 254> powers;
  powers[0] = Residue(1);
  for (std::size_t i = 1; i < powers.size(); ++i) powers[i] = powers[i - 1] + powers[i - 1];
  return powers;
}();

/// How often a finite float has the least positive one in it.
Residue residue(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t exponent = bits >> 23 & 0xff, fraction = bits & 0x7fffff;
  const Residue size =
      exponent == 0 ? Residue(fraction) : Residue(fraction | 0x800000) * k_powers_of_2[exponent - 1];
  return bits >> 31 == 0 ? size : Residue() - size;
}

struct Vector {
  Residue x, y, z;
  bool operator==(const Vector&) const = default;
};

Vector residues(glm::vec3 v) {
  return {residue(v.x), residue(v.y), residue(v.z)};
}

Vector operator-(const Vector& a, const Vector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

Vector cross(const Vector& a, const Vector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Residue dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// The normal n and its product with a point of the plane: all multiples of the four are the same plane.
struct Plane {
  Vector normal;
  Residue offset;

  /// The first component of the normal that is not 0; 0 if all are.
  Residue leading() const {
    for (const Residue component : {normal.x, normal.y}) {
      if (component != Residue()) return component;
    }
    return normal.z;
  }

  bool operator==(const Plane&) const = default;
};

Plane operator*(const Plane& plane, Residue factor) {
  const auto& [normal, offset] = plane;
  return {{normal.x * factor, normal.y * factor, normal.z * factor}, offset * factor};
}

Plane plane_of(const Geometry& geometry, const glm::uvec3& triangle) {
  const Vector a = residues(geometry.positions[triangle.x]);
  const Vector b = residues(geometry.positions[triangle.y]);
  const Vector c = residues(geometry.positions[triangle.z]);
  const Vector normal = cross(b - a, c - a);
  return {normal, dot(normal, a)};
}

/// Of a plane divided by its leading component. Residues are scattered as a hash is.
std::size_t hash(const Plane& plane) {
  const auto& [normal, offset] = plane;
  return normal.x.value() + 3 * normal.y.value() + 5 * normal.z.value() + 7 * offset.value();
}

}  // namespace

std::vector<std::uint32_t> planes_of(const Geometry& geometry) {
  const std::size_t triangle_count = geometry.triangles.size();
  std::vector<Plane> planes;
  std::vector<Residue> products;  // of the leading components of all planes so far, where there are any
  planes.reserve(triangle_count);
  products.reserve(triangle_count + 1);
  products.emplace_back(1);
  for (const glm::uvec3& triangle : geometry.triangles) {
    planes.push_back(plane_of(geometry, triangle));
    const Residue leading = planes.back().leading();
    products.push_back(leading == Residue() ? products.back() : products.back() * leading);
  }

  // Divide by the leading components, the last one first. An inverse is dear: that of the product gives all.
  Residue inverse_product = inverse(products.back());
  for (std::size_t t = triangle_count; t-- > 0;) {
    const Residue leading = planes[t].leading();
    if (leading == Residue()) continue;
    planes[t] = planes[t] * (inverse_product * products[t]);
    inverse_product = inverse_product * leading;
  }

  // Number them by an open hash table of the first triangle of each plane. At least half of it stays free.
  constexpr std::uint32_t k_none = ~0u;
  std::vector<std::uint32_t> table(std::bit_ceil(2 * triangle_count + 1), k_none);
  std::vector<std::uint32_t> result;
  result.reserve(triangle_count);
  std::uint32_t count = 0;
  for (std::uint32_t t = 0; t < triangle_count; ++t) {
    if (planes[t].leading() == Residue()) {
      result.push_back(count++);
      continue;
    }
    std::size_t slot = hash(planes[t]) % table.size();
    while (table[slot] != k_none && planes[table[slot]] != planes[t]) slot = (slot + 1) % table.size();
    const bool is_new = table[slot] == k_none;
    if (is_new) table[slot] = t;
    result.push_back(is_new ? count++ : result[table[slot]]);
  }
  return result;
}

}  // namespace airlight::scene
