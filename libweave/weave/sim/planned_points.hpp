#pragma once

#include <weave/curve/cloth_curves.hpp>
#include <weave/design/design.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

namespace weave::sim {

/// The control points of planned yarns, made from their key points when they are asked for. Not for several threads at once.
class PlannedPoints {
  public:
    /// Appends the key points of a curve from `first` to before `last`.
    using KeysOf = std::function<void(std::size_t curve, std::size_t first, std::size_t last, std::vector<KeyPoint>& to)>;
    /// What stays where it is planned.
    struct Held {
        std::array<Boundary, 2> rim{};                   ///< along x and y; `frozen` where the cloth is not periodic
        std::vector<std::vector<std::size_t>> crossings; ///< by curve: its key points there
    };

    /// `curves`: keys are not looked at; it and the design must outlive this. `keys`: how many each curve has. A yarn of more than
    /// `most_at_once` points is never looked at as a whole.
    PlannedPoints(const Design& design, const ClothCurves& curves, std::vector<std::size_t> keys, KeysOf keys_of, Held held,
                  double points_per_key, std::size_t most_at_once);

    [[nodiscard]] std::size_t most_at_once() const { return m_most_at_once; }
    [[nodiscard]] std::size_t keys(std::size_t curve) const { return m_keys[curve]; }
    [[nodiscard]] std::size_t count(std::size_t curve) const;
    /// Control points from `first` to before `last`, those of a periodic yarn beyond its ends as Spline::at() has them: the same
    /// bits whatever is asked for with them. A yarn that is not looked at as a whole is made in pieces, by splines that go on
    /// for `beside` key points on either side; what lies further would change them by 0.27 to that power.
    [[nodiscard]] std::vector<Vec3> control(std::size_t curve, std::ptrdiff_t first, std::ptrdiff_t last) const;
    /// Which of them are held: 1.
    [[nodiscard]] std::vector<std::uint8_t> frozen(std::size_t curve, std::ptrdiff_t first, std::ptrdiff_t last) const;
    /// Visits the keys of a curve in order, as long as the answer is true.
    void each_key(std::size_t curve, const std::function<bool(const KeyPoint&)>& visit) const;

  private:
    static constexpr std::ptrdiff_t beside = 40;
    /// Points of a long yarn that were made together.
    struct Made {
        std::size_t curve = 0, number = 0;
        std::vector<Vec3> control;
    };
    [[nodiscard]] bool is_short(std::size_t curve) const { return count(curve) <= m_most_at_once; }
    [[nodiscard]] const std::vector<Vec3>& made(std::size_t curve, std::size_t number) const;
    [[nodiscard]] std::vector<Vec3> make(std::size_t curve, std::ptrdiff_t first, std::ptrdiff_t last) const;
    [[nodiscard]] std::vector<Vec3> of_whole(std::size_t curve, std::ptrdiff_t first, std::ptrdiff_t last) const;
    [[nodiscard]] std::vector<Vec3> places(std::size_t curve, std::ptrdiff_t first, std::ptrdiff_t last) const;
    [[nodiscard]] std::vector<KeyPoint> key_points(std::size_t curve, std::size_t first, std::size_t last) const;
    void freeze_rim(std::size_t curve, std::size_t first, std::vector<std::uint8_t>& frozen) const;
    void hold(std::size_t curve, std::size_t key, std::size_t first, std::vector<std::uint8_t>& frozen) const;

    const Design& m_design;
    const ClothCurves& m_curves;
    std::vector<std::size_t> m_keys;
    KeysOf m_keys_of;
    Held m_held;
    double m_points_per_key;
    std::size_t m_most_at_once;
    mutable std::deque<Made> m_made;  ///< the last few
};

}  // namespace weave::sim
