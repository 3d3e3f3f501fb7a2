#pragma once

#include <studio/viewport/tube_model.hpp>

#include <array>
#include <limits>
#include <optional>
#include <vector>

namespace weave::studio {

/// How much of a model is shown.
struct Shown {
    std::array<std::size_t, 2> repeat{1, 1};  ///< pieces side by side along x and y; at most most_repeats
    std::optional<Plane> clip;                ///< what lies on the side that it points to is cut away
    friend bool operator==(const Shown& a, const Shown& b);
};
inline constexpr std::size_t most_repeats = 16;

/// Round all repeats.
Box box_of(const TubeModel& model, const std::array<std::size_t, 2>& repeat);

/// Where a ray meets a yarn.
struct Hit {
    std::uint32_t yarn = 0;
    Vec3 place{0, 0, 0};                                        ///< mm
    double distance = std::numeric_limits<double>::infinity();  ///< from where the ray begins
    bool is_cut = false;                                        ///< on the plane that cuts
};

/// Every yarn that a ray meets, each repeat of it once, the nearest first; not what is cut away.
std::vector<Hit> hits(const TubeModel& model, const Shown& shown, const Ray& ray);

/// The crossing that somebody points at: of the two topmost yarns under the cursor, near its middle.
std::optional<ModelCrossing> crossing_at(const TubeModel& model, const std::vector<Hit>& hits,
                                         const Ray& ray);

}  // namespace weave::studio
