#include <weave/picture/diff_view.hpp>

#include <weave/picture/change_rings.hpp>
#include <weave/picture/grid.hpp>

#include <algorithm>
#include <map>
#include <new>

namespace weave {

namespace {

/// Okabe and Ito's colours, which people of every kind of sight can tell apart.
constexpr Colour now_lifted{0x00, 0x72, 0xb2}, now_lowered{0xe6, 0x9f, 0x00}, inserted{0x00, 0x9e, 0x73},
    removed{0xcc, 0x79, 0xa7}, light_lifted{0xcf, 0xcf, 0xcf}, light_weft{0xf6, 0xf6, 0xf6},
    nowhere{0xff, 0xff, 0xff}, ring_line{0x00, 0x00, 0x00};
constexpr double rim = 26, rim_bar = 7;  ///< beside the card, and its bars

/// What is to be seen at one crossing; the larger the more it matters where crossings share a pixel.
enum class Sight : std::uint8_t {
    no_crossing,
    weft,
    lifted,
    removed_weft,
    removed_lifted,
    inserted_weft,
    inserted_lifted,
    becomes_lowered,
    becomes_lifted
};

Colour colour_of(Sight sight) {
    constexpr Colour white{0xff, 0xff, 0xff};
    switch (sight) {
        case Sight::no_crossing:
            return nowhere;
        case Sight::weft:
            return light_weft;
        case Sight::lifted:
            return light_lifted;
        case Sight::removed_weft:
            return mix(removed, white, 0.72);
        case Sight::removed_lifted:
            return removed;
        case Sight::inserted_weft:
            return mix(inserted, white, 0.72);
        case Sight::inserted_lifted:
            return inserted;
        case Sight::becomes_lowered:
            return now_lowered;
        case Sight::becomes_lifted:
            return now_lifted;
    }
    return nowhere;
}

/// One line of the picture: the pick (or end) that it is before and after.
struct MergedLine {
    MergedSpan::Kind kind;
    std::size_t before, after;
};

std::vector<MergedLine> lines_of(const LineAlignment& alignment) {
    std::vector<MergedLine> lines;
    for (const MergedSpan& span : merged(alignment)) {
        for (std::size_t k = 0; k < span.count; ++k) {
            const bool gone = span.kind == MergedSpan::Kind::removed,
                       is_new = span.kind == MergedSpan::Kind::inserted;
            lines.push_back({span.kind, span.before + (is_new ? 0 : k), span.after + (gone ? 0 : k)});
        }
    }
    return lines;
}

/// Both cards on one grid of merged picks and ends.
struct MergedCard {
    const CardImage &before, &after;
    std::vector<MergedLine> picks, ends;

    [[nodiscard]] Sight at(std::size_t row, std::size_t column) const {
        using enum MergedSpan::Kind;
        const MergedLine &pick = picks[row], &end = ends[column];
        const bool gone = pick.kind == removed || end.kind == removed;
        const bool is_new = pick.kind == inserted || end.kind == inserted;
        if (gone && is_new) return Sight::no_crossing;
        if (gone)
            return before.weft_over(pick.before, end.before) ? Sight::removed_weft : Sight::removed_lifted;
        const bool weft = after.weft_over(pick.after, end.after);
        if (is_new) return weft ? Sight::inserted_weft : Sight::inserted_lifted;
        if (before.weft_over(pick.before, end.before) == weft) return weft ? Sight::weft : Sight::lifted;
        return weft ? Sight::becomes_lowered : Sight::becomes_lifted;
    }

    /// What matters most of the crossings that share a pixel; of those that stay, how many are lifted.
    [[nodiscard]] std::uint32_t shared_pixel(std::size_t row, std::size_t column, std::size_t step) const {
        Sight most = Sight::no_crossing;
        std::size_t all = 0, lifted = 0;
        for (std::size_t r = row; r < std::min(row + step, picks.size()); ++r) {
            for (std::size_t c = column; c < std::min(column + step, ends.size()); ++c) {
                const Sight sight = at(r, c);
                most = std::max(most, sight);
                ++all;
                lifted += sight == Sight::lifted ? 1 : 0;
            }
        }
        if (most > Sight::lifted) return pixel_of(colour_of(most));
        return pixel_of(
            mix(light_weft, light_lifted, static_cast<double>(lifted) / static_cast<double>(all)));
    }
};

/// Crossings as rectangles, those of one colour side by side as one: a small card stays a drawing in SVG.
void draw_cells(Canvas& canvas, const MergedCard& card, const Grid& grid) {
    std::map<Sight, std::vector<Rectangle>> places;
    const auto side = static_cast<double>(grid.cell);
    for (std::size_t row = 0; row < grid.rows; ++row) {
        for (std::size_t column = 0; column < grid.columns;) {
            const Sight sight = card.at(row, column);
            std::size_t next = column + 1;
            while (next < grid.columns && card.at(row, next) == sight) ++next;
            const Rectangle first = grid.box(row, column);
            places[sight].push_back({first.x, first.y, static_cast<double>(next - column) * side, side});
            column = next;
        }
    }
    for (const auto& [sight, rectangles] : places) canvas.rectangles(rectangles, colour_of(sight));
}

void draw_grid_lines(Canvas& canvas, const Grid& grid) {
    if (grid.cell < 8) return;
    std::vector<Point> lines;
    const double left = grid.x_of(0), right = grid.x_of(static_cast<double>(grid.columns));
    const double bottom = grid.y_of(0), top = grid.y_of(static_cast<double>(grid.rows));
    for (std::size_t row = 1; row < grid.rows; ++row) {
        const double y = grid.y_of(static_cast<double>(row)) - 0.5;
        lines.insert(lines.end(), {{left, y}, {right, y}});
    }
    for (std::size_t column = 1; column < grid.columns; ++column) {
        const double x = grid.x_of(static_cast<double>(column)) - 0.5;
        lines.insert(lines.end(), {{x, top}, {x, bottom}});
    }
    canvas.lines(lines, {.colour = {0xb4, 0xb4, 0xb4}, .width = 1, .round = false});
}

/// A standing bar where an end is lifted now, a lying one where the weft lies over now.
void draw_bars(Canvas& canvas, const MergedCard& card, const Grid& grid) {
    if (grid.cell < 8) return;
    std::vector<Point> standing, lying;
    const double reach = static_cast<double>(grid.cell) * 0.28;
    for (std::size_t row = 0; row < grid.rows; ++row) {
        for (std::size_t column = 0; column < grid.columns; ++column) {
            const Sight sight = card.at(row, column);
            const Point middle = grid.centre(row, column);
            if (sight == Sight::becomes_lifted)
                standing.insert(standing.end(), {{middle.x, middle.y - reach}, {middle.x, middle.y + reach}});
            if (sight == Sight::becomes_lowered)
                lying.insert(lying.end(), {{middle.x - reach, middle.y}, {middle.x + reach, middle.y}});
        }
    }
    const double width = std::max(1.5, static_cast<double>(grid.cell) / 8);
    canvas.lines(standing, {.colour = ink_on(now_lifted), .width = width, .round = false});
    canvas.lines(lying, {.colour = ink_on(now_lowered), .width = width, .round = false});
}

/// Which merged lines have something to tell: by the colour that tells it.
struct RimLines {
    std::vector<bool> changed;  ///< matched, with crossings that differ
    const std::vector<MergedLine>& lines;
};

/// Calls bar(first, last, colour) for runs of lines of one colour.
template <class Bar>
void each_rim_bar(const RimLines& rim_lines, Bar bar) {
    const auto colour = [&](std::size_t k) -> std::optional<Colour> {
        if (rim_lines.lines[k].kind == MergedSpan::Kind::inserted) return inserted;
        if (rim_lines.lines[k].kind == MergedSpan::Kind::removed) return removed;
        return rim_lines.changed[k] ? std::optional<Colour>(ink) : std::nullopt;
    };
    for (std::size_t k = 0; k < rim_lines.lines.size();) {
        const std::optional<Colour> here = colour(k);
        std::size_t next = k + 1;
        while (next < rim_lines.lines.size() && colour(next) == here) ++next;
        if (here) bar(k, next, *here);
        k = next;
    }
}

/// `+` beside what was inserted and `-` beside what was removed, where there is room.
void draw_sign(Canvas& canvas, Point at, Colour colour) {
    if (colour == ink) return;
    canvas.text(
        at, colour == inserted ? "+" : "-",
        {.size = 13, .colour = readable(colour), .anchor = Anchor::middle, .bold = true, .centred = true});
}

void draw_rims(Canvas& canvas, const Grid& grid, const RimLines& picks, const RimLines& ends) {
    constexpr double least = 2, room_for_sign = 8;
    const double right = grid.corner.x + static_cast<double>(grid.width()) + 4,
                 top = grid.corner.y - 4 - rim_bar;
    each_rim_bar(picks, [&](std::size_t first, std::size_t after, Colour colour) {
        const double y = grid.y_of(static_cast<double>(after)), low = grid.y_of(static_cast<double>(first));
        canvas.rectangle({right, y, rim_bar, std::max(least, low - y)}, colour);
        if (low - y >= room_for_sign) draw_sign(canvas, {right + rim_bar + 7, (low + y) / 2}, colour);
    });
    each_rim_bar(ends, [&](std::size_t first, std::size_t after, Colour colour) {
        const double x = grid.x_of(static_cast<double>(first)), far = grid.x_of(static_cast<double>(after));
        canvas.rectangle({x, top, std::max(least, far - x), rim_bar}, colour);
        if (far - x >= room_for_sign) draw_sign(canvas, {(x + far) / 2, top - 7}, colour);
    });
}

/// Where something changed on matched picks and ends.
struct ChangedPlaces {
    std::vector<bool> picks, ends;
    std::vector<Ring> rings;
    double ring_width = 0;
};

ChangedPlaces changes_of(const MergedCard& card, const Grid& grid) {
    ChangedPlaces changes{std::vector<bool>(card.picks.size()), std::vector<bool>(card.ends.size()), {}, 0};
    ChangeRings rings(grid);
    for (std::size_t row = 0; row < card.picks.size(); ++row) {
        for (std::size_t column = 0; column < card.ends.size(); ++column) {
            if (card.at(row, column) < Sight::becomes_lowered) continue;
            changes.picks[row] = true;
            changes.ends[column] = true;
            rings.add(row, column);
        }
    }
    changes.rings = rings.rings();
    changes.ring_width = rings.line();
    return changes;
}

/// On white, so that a ring stands out on dark places as well.
void draw_rings(Canvas& canvas, const ChangedPlaces& changes) {
    constexpr Colour white{0xff, 0xff, 0xff};
    for (const Ring& ring : changes.rings)
        canvas.ring(ring.centre, ring.radius, {.colour = white, .width = 2 * changes.ring_width});
    for (const Ring& ring : changes.rings)
        canvas.ring(ring.centre, ring.radius, {.colour = ring_line, .width = changes.ring_width});
}

std::string title_of(const Design& design) {
    return printable(design.title.empty() ? design.root : design.title, 60);
}

PageText words_of(const WovenDesign& before, const WovenDesign& after, const CardDiff& card, const Grid& grid,
                  bool has_rings) {
    PageText text;
    const std::string old = title_of(before.design), now = title_of(after.design);
    text.title = old == now ? now : now + ", compared with " + old;
    text.subtitle = "card image compared  ·  " + in_words(card);
    text.legend = {
        {"changed", {{now_lifted, "end lifted now"}, {now_lowered, "weft over now, end no longer lifted"}}},
        {"as before", {{light_lifted, "end lifted"}, {light_weft, "weft over warp"}}}};
    const auto &picks = card.alignment.picks, &ends = card.alignment.ends;
    LegendRow bands{"lines", {}};
    if (picks.matched() < picks.after || ends.matched() < ends.after)
        bands.swatches.push_back({inserted, "inserted (+), lifted ends darker"});
    if (picks.matched() < picks.before || ends.matched() < ends.before)
        bands.swatches.push_back({removed, "removed (-), lifted ends darker"});
    if (!bands.swatches.empty()) text.legend.push_back(bands);
    if (has_rings)
        text.legend.push_back(
            {"found by", {{ring_line, "ring round changes too small to be seen from afar"}}});
    text.notes = scale_notes(grid, "and shows a change where one of them changed");
    text.notes.push_back(
        "Numbers are those of the design after. Bars above and beside the card mark picks and ends with "
        "changes.");
    return text;
}

Result<std::string> draw_merged(const MergedCard& card, const Grid& grid, const PageText& text,
                                const ChangedPlaces& changes, PictureFormat format, const DiffLook& look) {
    WEAVE_TRY(Page page, Page::open(format, text, grid_left + static_cast<double>(grid.width()) + rim,
                                    rim + static_cast<double>(grid.height()) + grid_bottom, look.marks, look.scale));
    if (grid.cell >= 4) {
        draw_cells(page.canvas, card, grid);
    } else {
        page.canvas.pixels(static_cast<std::size_t>(grid.corner.x), static_cast<std::size_t>(grid.corner.y),
                           grid.width(), grid.height(), [&](std::size_t y, std::span<std::uint32_t> row) {
                               const std::size_t step = grid.step;
                               for (std::size_t x = 0; x < row.size(); ++x)
                                   row[x] = card.shared_pixel(grid.row_at(y), grid.column_at(x), step);
                           });
    }
    draw_grid_lines(page.canvas, grid);
    draw_bars(page.canvas, card, grid);
    draw_rims(page.canvas, grid, {changes.picks, card.picks}, {changes.ends, card.ends});
    const auto number = [](const std::vector<MergedLine>& lines) {
        return [&lines](std::size_t k) {
            return k < lines.size()
                       ? lines[k].after
                       : lines.back().after + (lines.back().kind == MergedSpan::Kind::removed ? 0 : 1);
        };
    };
    draw_rulers(page.canvas, grid, {number(card.picks), number(card.ends)});
    draw_rings(page.canvas, changes);
    return std::move(page.canvas).finish();
}

}  // namespace

Result<std::string> draw_diff(const WovenDesign& before, const WovenDesign& after, const DesignDiff& diff,
                              PictureFormat format, const DiffLook& look) {
    if (!diff.card || !before.cloth || !after.cloth)
        return invalid("the cards cannot be drawn: " + diff.no_card);
    try {
        const MergedCard card{before.cloth->card, after.cloth->card, lines_of(diff.card->alignment.picks),
                              lines_of(diff.card->alignment.ends)};
        Grid grid = make_grid(card.picks.size(), card.ends.size(), 28, look.wanted_side, look.longest_side);
        grid.corner.y = (look.has_words ? Page::body_top : Page::margin) + rim;
        const ChangedPlaces changes = changes_of(card, grid);
        PageText text = words_of(before, after, *diff.card, grid, !changes.rings.empty());
        if (!look.has_words) text = {{}, {}, std::move(text.legend), {}};
        return draw_merged(card, grid, text, changes, format, look);
    } catch (const std::bad_alloc&) {
        return system_fault("there is not enough memory to draw this comparison");
    }
}

}  // namespace weave
