#include <weave/picture/page.hpp>

#include <algorithm>

namespace weave {

namespace {

constexpr double swatch_side = 12, swatch_gap = 18, row_height = 20;
constexpr double small_size = Page::small_size;

double swatch_width(const Swatch& swatch) {
    return swatch_side + 6 + Canvas::text_width(swatch.text, small_size) + swatch_gap;
}

/// The legend broken into rows that fit; a continued row has no label.
std::vector<LegendRow> broken(const std::vector<LegendRow>& legend, double width) {
    std::vector<LegendRow> rows;
    for (const LegendRow& row : legend) {
        rows.push_back({row.label, {}});
        double used = 0;
        for (const Swatch& swatch : row.swatches) {
            const double wide = swatch_width(swatch);
            if (used > 0 && used + wide > width) {
                rows.emplace_back();
                used = 0;
            }
            rows.back().swatches.push_back(swatch);
            used += wide;
        }
    }
    return rows;
}

void draw_legend(Canvas& canvas, const std::vector<LegendRow>& rows, double left, double label_width,
                 double top) {
    for (const LegendRow& row : rows) {
        const double middle = top + swatch_side / 2;
        canvas.text({left, middle}, row.label, {.size = small_size, .centred = true});
        double x = left + label_width;
        for (const Swatch& swatch : row.swatches) {
            canvas.rectangle({x, top, swatch_side, swatch_side}, swatch.colour);
            canvas.outline({x + 0.5, top + 0.5, swatch_side - 1, swatch_side - 1},
                           {.colour = {0x90, 0x90, 0x90}, .width = 1});
            canvas.text({x + swatch_side + 6, middle}, swatch.text, {.size = small_size, .centred = true});
            x += swatch_width(swatch);
        }
        top += row_height;
    }
}

}  // namespace

Result<Page> Page::open(const Subject& subject, const PageText& text, double body_width, double body_height) {
    return open(subject.format, text, body_width, body_height, subject.marks);
}

Result<Page> Page::open(PictureFormat format, const PageText& text, double body_width, double body_height,
                        std::vector<Mark>* marks, int scale) {
    double width = std::max({body_width, 300.0, Canvas::text_width(text.title, title_size, true),
                             Canvas::text_width(text.subtitle, small_size)});
    for (const std::string& note : text.notes) width = std::max(width, Canvas::text_width(note, small_size));
    double label_width = 0;
    for (const LegendRow& row : text.legend) {
        if (!row.label.empty())
            label_width = std::max(label_width, Canvas::text_width(row.label, small_size) + 12);
    }
    for (const LegendRow& row : text.legend) {
        for (const Swatch& swatch : row.swatches)
            width = std::max(width, label_width + swatch_width(swatch) - swatch_gap);
    }
    const std::vector<LegendRow> legend = broken(text.legend, width - label_width);
    const double words =
        row_height * static_cast<double>(legend.size()) + 17 * static_cast<double>(text.notes.size());
    const double top = top_of(text);
    const double bottom = top + body_height + (words > 0 ? 18 + words : 0);
    WEAVE_TRY(Canvas canvas, Canvas::make(format, width + 2 * margin, bottom + margin, scale));
    canvas.list_marks(marks);
    canvas.text({margin, margin + 15}, text.title,
                {.size = title_size, .colour = {0x11, 0x11, 0x11}, .bold = true});
    canvas.text({margin, margin + 34}, text.subtitle, {.size = small_size, .colour = {0x60, 0x60, 0x60}});
    double y = top + body_height + 18;
    draw_legend(canvas, legend, margin, label_width, y);
    y += row_height * static_cast<double>(legend.size());
    for (const std::string& note : text.notes) {
        canvas.text({margin, y + 11}, note, {.size = small_size, .colour = {0x60, 0x60, 0x60}});
        y += 17;
    }
    return Page{std::move(canvas), {margin, top, body_width, body_height}};
}

bool has_loose(const Stack& stack) {
    return std::ranges::any_of(stack.slots(), &Slot::is_loose);
}

PageText words_of(const Subject& subject, const std::string& view) {
    const Block& block = subject.block;
    PageText text;
    text.title = printable(subject.design.title.empty() ? subject.design.root : subject.design.title, 80);
    text.subtitle = view + "  ·  " + std::to_string(block.picks()) +
                    (block.picks() == 1 ? " pick × " : " picks × ") + std::to_string(block.ends()) +
                    (block.ends() == 1 ? " end" : " ends");
    return text;
}

}  // namespace weave
