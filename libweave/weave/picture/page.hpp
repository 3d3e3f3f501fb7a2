#pragma once

#include <weave/picture/canvas.hpp>

#include <string>
#include <vector>

namespace weave {

/// What a picture is made from.
struct Subject {
    const Design& design;
    const Block& block;
    PictureRequest request;
    PictureFormat format = PictureFormat::png;
    std::vector<Mark>* marks = nullptr;  ///< where to list what is drawn, or nowhere
};

/// A patch of colour in a legend, and what it stands for.
struct Swatch {
    Colour colour;
    std::string text;
};

/// One line of a legend. A label of several lines of legend is padded to one width.
struct LegendRow {
    std::string label;  ///< may be empty
    std::vector<Swatch> swatches;
};

/// The words round a picture: a bold title, a line below it, and beneath the picture legend and notes.
struct PageText {
    std::string title, subtitle;
    std::vector<LegendRow> legend;
    std::vector<std::string> notes;
};

/// A page whose words stand and whose body is still to be drawn.
struct Page {
    /// White rim of every page, and where its body begins, in pixels.
    static constexpr double margin = 24, body_top = 74;
    /// Sizes of the title's letters and of all others.
    static constexpr double title_size = 16, small_size = 11.5;
    /// Body of this size; the page is made wide enough for its words.
    static Result<Page> open(const Subject& subject, const PageText& text, double body_width,
                             double body_height);
    static Result<Page> open(PictureFormat format, const PageText& text, double body_width, double body_height,
                             std::vector<Mark>* marks = nullptr, int scale = 1);
    /// Where the body of a page with these words begins: right below the rim where there are none above it.
    static double top_of(const PageText& text) { return text.title.empty() && text.subtitle.empty() ? margin : body_top; }
    Canvas canvas;
    Rectangle body;
};

/// Whether some yarn of a stack is loose on purpose.
bool has_loose(const Stack& stack);

/// Title and size of the cloth: `Twill sample` over `card image · face up · 8 picks × 8 ends`.
PageText words_of(const Subject& subject, const std::string& view);

inline constexpr Colour ink{0x33, 0x33, 0x33}, faint_ink{0x80, 0x80, 0x80}, accent{0x00, 0x72, 0xb2};

}  // namespace weave
