#pragma once

#include <weave/core/colour.hpp>
#include <weave/core/result.hpp>
#include <weave/picture/picture.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// A place in a picture, in pixels from its top left corner.
struct Point {
    double x = 0, y = 0;
};

struct Rectangle {
    double x = 0, y = 0, width = 0, height = 0;
};

/// How a line is drawn; lengths in pixels.
struct Stroke {
    Colour colour;
    double width = 1;
    double alpha = 1;
    bool round = true;           ///< round caps and joins; otherwise lines end square where they end
    std::vector<double> dash{};  ///< lengths of line and gap; empty: a whole line
};

enum class Anchor : std::uint8_t { start, middle, end };

struct TextStyle {
    double size = 11;
    Colour colour{0x33, 0x33, 0x33};
    Anchor anchor = Anchor::start;
    bool bold = false;
    bool centred = false;  ///< the point is the middle of the letters' height, not the base line
    double angle = 0;      ///< radians, clockwise on the screen
};

/// Something drawn that carries meaning by where it stands: a word, an arrow head, a line.
struct Mark {
    enum class Kind : std::uint8_t { text, arrow, line };
    Kind kind = Kind::text;
    std::vector<Point> points;  ///< where the word stands; tip of the arrow; points of the line as drawn
    Colour colour;
    double size = 0;    ///< of the letters, length of the arrow, width of the line, in pixels
    Point direction{};  ///< of an arrow, length 1
    std::string text{};
    Anchor anchor = Anchor::start;
    bool bold = false, dashed = false;
};

/// A picture in the making, as PNG or SVG, over cairo. Drawing never fails by itself: finish() reports what
/// went wrong.
class Canvas {
  public:
    /// No picture has a longer side, in pixels.
    static constexpr double longest_side = 16000;
    /// Nor more pixels: 400 MB of memory while it is drawn.
    static constexpr double most_pixels = 1e8;

    /// A white page, of which a PNG has `scale` × `scale` pixels to each. An error where it would be larger than the limits.
    static Result<Canvas> make(PictureFormat format, double width, double height, int scale = 1);

    void rectangle(const Rectangle& place, Colour fill, double alpha = 1);
    /// Many rectangles of one colour as one shape, which keeps SVG small.
    void rectangles(std::span<const Rectangle> places, Colour fill);
    void outline(const Rectangle& place, const Stroke& stroke);
    void polyline(std::span<const Point> points, const Stroke& stroke);
    /// Separate straight lines, drawn as one shape: points 2k and 2k+1 are the ends of line k.
    void lines(std::span<const Point> ends, const Stroke& stroke);
    /// A chain of cubic Bézier pieces: the first point, then three points a piece.
    void curve(std::span<const Point> points, const Stroke& stroke);
    void polygon(std::span<const Point> points, Colour fill);
    void circle(Point centre, double radius, Colour fill);
    void ring(Point centre, double radius, const Stroke& stroke);
    /// A piece of round yarn along the longer axis it is told: rounded ends, light along its middle.
    void yarn(const Rectangle& place, bool along_x, Colour colour);
    /// A filled arrow head whose tip is at `tip`.
    void arrow_head(Point tip, Point direction, double length, Colour fill);
    /// Characters that are not UTF-8 come out as question marks, long text is cut with an ellipsis.
    void text(Point at, std::string_view text, const TextStyle& style = {});
    /// Single pixels from a whole-numbered place on: `fill(row, pixels)` writes the colours (0xrrggbb) of one
    /// row, from the top.
    void pixels(std::size_t x, std::size_t y, std::size_t width, std::size_t height,
                const std::function<void(std::size_t, std::span<std::uint32_t>)>& fill);
    /// Only what lies in this place is drawn, until unclip().
    void clip(const Rectangle& place);
    void unclip();

    /// From now on lists what is drawn here too; the list must outlive the canvas.
    void list_marks(std::vector<Mark>* marks);

    /// The picture file. Errors: memory ran out, or cairo could not draw.
    Result<std::string> finish() &&;

    /// Width of a text in pixels.
    static double text_width(std::string_view text, double size, bool bold = false);

  private:
    void list_line(std::span<const Point> points, const Stroke& stroke);
    struct State;
    struct Close {
        void operator()(State* state) const;
    };
    explicit Canvas(std::unique_ptr<State, Close> state) : m_state(std::move(state)) {}
    std::unique_ptr<State, Close> m_state;
};

/// Mixes two colours: 0 is `a`, 1 is `b`.
Colour mix(Colour a, Colour b, double share);
/// The colour as a pixel 0xrrggbb.
std::uint32_t pixel_of(Colour colour);
/// Black or white, whichever reads better on this colour.
Colour ink_on(Colour ground);
/// A tone of this colour that reads on white.
Colour readable(Colour colour);
/// Text that cairo accepts: valid UTF-8 without control characters, at most `most` characters.
std::string printable(std::string_view text, std::size_t most = 96);

}  // namespace weave
