#pragma once

#include <weave/core/json.hpp>
#include <weave/picture/tube_piece.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace weave::studio {

/// The views that keys 1 to 6 ask for, in this order.
enum class StandardView : std::uint8_t { face, back, warp_side, weft_side, corner, opposite_corner };
inline constexpr std::size_t standard_views = 6;

/// A box along the cloth's axes, mm.
struct Box {
    Vec3 low{0, 0, 0}, high{0, 0, 0};
    [[nodiscard]] Vec3 centre() const { return (low + high) / 2; }
    [[nodiscard]] Vec3 size() const { return high - low; }
    [[nodiscard]] std::array<Vec3, 8> corners() const;
};

/// A place in a picture of the cloth, pixels from its top left corner, and how far away it lies, mm.
struct Projected {
    double x = 0, y = 0, away = 0;
};

/// The picture that a camera fills, pixels.
struct PictureSize {
    double width = 1, height = 1;
};

/// Looks at cloth from any side, with z never upside down, so that nobody loses his way. The cloth's axes are
/// left-handed (x up and y to the right on the face), and so are the camera's (right, up, away), which are
/// those of TubeCamera: the cloth is never seen in a mirror.
class Camera {
  public:
    /// From above the first pick and end, as pictures of relaxed cloth are drawn.
    double azimuth_deg = 32, elevation_deg = 38;  ///< as ClothView's
    Vec3 centre{0, 0, 0};                         ///< what lies in the middle of the picture, mm
    double height_mm = 10;                        ///< of what the picture shows at the centre
    bool perspective = false;                     ///< a mild one

    friend bool operator==(const Camera&, const Camera&) = default;

    [[nodiscard]] Vec3 right() const;
    [[nodiscard]] Vec3 up() const;
    [[nodiscard]] Vec3 away() const;
    /// Of the eye from the centre; 0 without perspective.
    [[nodiscard]] double distance() const;
    /// Pixels of a mm, at the centre's distance.
    [[nodiscard]] double scale(const PictureSize& size) const { return size.height / height_mm; }

    /// Right, up and away from the eye (without perspective: from the centre), mm.
    [[nodiscard]] Vec3 to_camera(const Vec3& place) const;
    /// With perspective, of places before the eye only.
    [[nodiscard]] Projected project(const Vec3& place, const PictureSize& size) const;
    /// What is seen at a place in the picture, in the cloth's axes. Without perspective it begins before
    /// everything within `reach_mm` of the centre.
    [[nodiscard]] Ray ray(double x, double y, const PictureSize& size, double reach_mm = 1e4) const;

    /// The cloth follows the mouse, so many degrees; above and below is the end.
    void orbit(double right_deg, double down_deg);
    /// The cloth at the centre's distance follows the mouse, so many pixels.
    void pan(double right, double down, const PictureSize& size);
    /// Makes everything `factor` times as large; what lies under (x, y) at the centre's distance stays there.
    void zoom_at(double x, double y, double factor, const PictureSize& size);
    /// Turns only.
    void turn_to(StandardView view);
    /// Moves and zooms only: all of the box, with a rim.
    void fit(const Box& box, const PictureSize& size);

    /// For documents; numbers that a document must not carry are refused, and the camera is then as before.
    [[nodiscard]] Json to_json() const;
    Status from_json(const Json& json);

  private:
    [[nodiscard]] Vec3 in_plane(double x, double y, const PictureSize& size) const;
};

/// The view a share (0 to 1) of the way from one to the other, the shorter way round.
Camera between(const Camera& from, const Camera& to, double share);

/// The standard view that a camera has turned to, if any.
std::optional<StandardView> view_of(const Camera& camera);

}  // namespace weave::studio
