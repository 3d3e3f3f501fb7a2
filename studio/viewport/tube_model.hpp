#pragma once

#include <weave/block/stack.hpp>
#include <weave/curve/cloth_curves.hpp>
#include <weave/design/design.hpp>
#include <weave/sim/yarns.hpp>
#include <studio/viewport/camera.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace weave::studio {

/// What colours the yarns.
enum class ColourBy : std::uint8_t { yarn, system, strain, contact, moved };
inline constexpr std::size_t colourings = 5;

/// Where two pieces of a yarn meet, as it lies in the memory of the GPU: the place and the yarn's radius, mm;
/// its direction, of length 1, and what colours it.
struct Knot {
    float x = 0, y = 0, z = 0, radius = 1;
    float along_x = 1, along_y = 0, along_z = 0, value = 0;
    [[nodiscard]] Vec3 place() const { return {x, y, z}; }
    [[nodiscard]] Vec3 tangent() const { return {along_x, along_y, along_z}; }
};

/// A straight piece, from knot to knot, as it lies in the memory of the GPU.
struct PieceLink {
    /// Nearer than its radius to the yarn's start or end: it is cut flat there, as its round end would stand
    /// out.
    static constexpr std::uint32_t near_start = 1, near_end = 2;
    std::uint32_t from = 0, to = 0, yarn = 0, flags = 0;
};

/// One yarn, with what it is called by.
struct ModelYarn {
    System system = System::warp;
    std::size_t number = 0;  ///< the end or (first) pick, from 0
    std::uint32_t beam = 0;  ///< of an end, from 0
    double radius_mm = 0;
    Colour colour;
    std::uint32_t first_knot = 0, knots = 0;
    [[nodiscard]] std::uint32_t last_knot() const { return first_knot + knots - 1; }
};

/// Where a pick and an end cross; of several repeats of the piece the place in the first.
struct ModelCrossing {
    std::uint32_t weft = 0, warp = 0;  ///< indices of the yarns
    std::size_t pick = 0, end = 0;     ///< from 0
    Vec3 place{0, 0, 0};               ///< mm, midway between the two
};

/// Consecutive pieces and the box round them, round ends included, by which many are left out at once.
struct Chunk {
    std::uint32_t first = 0, count = 0;
    Eigen::Vector3f low{0, 0, 0}, high{0, 0, 0};  ///< mm
};

/// The same yarns in fewer pieces, which stray further from them.
struct Level {
    double error_mm = 0;
    std::uint32_t first = 0, count = 0;  ///< of the pieces
    std::uint32_t first_flat = 0;        ///< from here on pieces that are cut flat at an end of their yarn
    std::vector<Chunk> chunks;
};

/// What a viewer shows: yarns as straight round pieces, and what is known of them. Knows neither window nor
/// OpenGL. A model is of one piece of cloth; how often it is repeated is the viewer's.
class TubeModel {
  public:
    /// The planned curves of a block, smooth through their key points.
    static Result<TubeModel> planned(const Design& design, const ClothCurves& curves,
                                     ColourBy colour = ColourBy::yarn);
    /// Relaxed yarns. Errors: no yarn; too many for a picture; values that are missing.
    static Result<TubeModel> relaxed(std::shared_ptr<const Yarns> yarns, ColourBy colour = ColourBy::yarn);

    /// Colours the yarns anew. Time grows with the knots.
    void set_colour(ColourBy colour);
    /// Control points of the same yarns as they lie now, in their order, for each yarn any number of at least
    /// 2 (periodic: 1). Pieces stay the same in number. Strain and contact are those of the yarns that the
    /// model was made of, which values_are_old() tells. Refused, with nothing changed, where the yarns are
    /// not as many, or one has too few points.
    Status update(const std::vector<std::vector<Vec3>>& control);

    [[nodiscard]] const std::vector<Knot>& knots() const { return m_knots; }
    [[nodiscard]] const std::vector<PieceLink>& pieces() const { return m_pieces; }
    [[nodiscard]] const std::vector<ModelYarn>& yarns() const { return m_yarns; }
    /// The finest first.
    [[nodiscard]] const std::vector<Level>& levels() const { return m_levels; }
    [[nodiscard]] const std::vector<ModelCrossing>& crossings() const { return m_crossings; }
    [[nodiscard]] TubePiece piece(std::size_t index) const;

    [[nodiscard]] ColourBy colour() const { return m_colour; }
    [[nodiscard]] bool is_scalar() const { return m_colour >= ColourBy::strain; }
    [[nodiscard]] double low() const { return m_low; }
    [[nodiscard]] double high() const { return m_high; }
    [[nodiscard]] bool values_are_old() const {
        return m_is_live && is_scalar() && m_colour != ColourBy::moved;
    }

    /// Round all yarns of the piece.
    [[nodiscard]] const Box& box() const { return m_box; }
    [[nodiscard]] const std::array<double, 2>& size_mm() const { return m_source->size_mm; }
    [[nodiscard]] const std::array<bool, 2>& is_periodic() const { return m_source->is_periodic; }
    [[nodiscard]] double thinnest_mm() const { return m_thinnest; }

    /// The crossing of two yarns (in any order) nearest to a place, repeats of the piece counted; nothing
    /// where they do not cross.
    [[nodiscard]] std::optional<ModelCrossing> crossing_of(std::uint32_t yarn, std::uint32_t other,
                                                           const Vec3& near) const;
    /// A yarn's index. In wraparound a pick may be part of a yarn that is named by an earlier one.
    [[nodiscard]] std::optional<std::uint32_t> find(System system, std::size_t number) const;
    /// The pick or end that a yarn is at a place: in wraparound a yarn has several picks.
    [[nodiscard]] std::size_t number_at(std::uint32_t yarn, const Vec3& place) const;
    /// The distance of two places, of one the nearest repeat.
    [[nodiscard]] double apart(const Vec3& a, const Vec3& b) const;

  private:
    TubeModel() = default;
    void lay_out();
    using Joints = std::vector<std::uint32_t>;  ///< knots of a yarn at which its pieces meet
    void add_levels();
    void add_level(double error_mm, const std::vector<Joints>& joints);
    [[nodiscard]] Joints fewer(const Joints& joints, double room_mm) const;
    void add_pieces(std::uint32_t yarn, const Joints& joints);
    void place_knots(const std::vector<Spline>& splines);
    void measure();
    void set_values();
    void find_crossings();

    std::shared_ptr<const Yarns> m_source;
    std::vector<std::vector<double>> m_parameters;  ///< of each yarn's knots, as shares of its spline
    std::vector<Spline> m_now;                      ///< as they lie now, once updated
    std::vector<Knot> m_knots;
    std::vector<PieceLink> m_pieces;
    std::vector<ModelYarn> m_yarns;
    std::vector<Level> m_levels;
    std::vector<ModelCrossing> m_crossings;  ///< sorted by weft and warp
    ColourBy m_colour = ColourBy::yarn;
    double m_low = 0, m_high = 1, m_thinnest = 1;
    bool m_is_live = false;
    Box m_box;
};

}  // namespace weave::studio
