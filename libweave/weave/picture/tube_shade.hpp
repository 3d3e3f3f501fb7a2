#pragma once

#include <weave/picture/tube_scene.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace weave {

/// How much of the sky other yarns take from a place, so that hollows are dark and depth can be read. Yarns
/// are taken as chains of short rods; each hides the solid angle that it fills, weighed with the cosine to
/// the surface, and counts less the further away it is, nothing beyond six of its radii. Without chance, so
/// pictures have no grain.
class Occlusion {
  public:
    explicit Occlusion(const TubeScene& scene);
    /// The sum of what is hidden: 0 in the open, about 1 in a narrow gap.
    [[nodiscard]] float hidden(const Vec3& place, const Vec3& normal) const;

  private:
    struct Rod {
        Eigen::Vector3f centre, along;  ///< `along` has length 1
        float length, radius, reach;
    };
    struct Entry {
        std::uint32_t cell, rod;
    };
    struct Cells {
        std::int64_t from[3], to[3];
    };
    void add_rods(const TubeScene& scene);
    void fill_grid();
    [[nodiscard]] Cells cells_of(const Rod& rod) const;
    [[nodiscard]] std::int64_t cell_at(float coordinate) const;

    std::vector<Rod> m_rods;
    float m_cell = 1;
    std::uint32_t m_mask = 0;
    std::vector<std::uint32_t> m_first;  ///< of the entries of each bucket of the hashed grid
    std::vector<Entry> m_entries;
};

/// Red, green and blue as amounts of light, 0 to 1.
using Light = Eigen::Array3f;

Light to_light(Colour colour);
std::uint32_t to_pixel(const Light& light);

/// The light that a round yarn sends to the viewer. `way` is that of the ray; `even` flattens the shading, so
/// that colours that stand for numbers stay near those of the bar.
Light shaded(const Light& colour, const Vec3& normal, const Vec3& way, float hidden, bool even);

}  // namespace weave
