#include <weave/picture/slice_map.hpp>
#include <weave/picture/space.hpp>
#include <weave/picture/views.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weave {

namespace {

constexpr double overhang = 0.72, base_level = -1.1;
constexpr std::size_t most_shown = 24;  ///< rows, and columns
constexpr std::size_t most_shown_stacks = 144;
constexpr std::size_t most_shown_slots = 2000;
constexpr double box_width = 30, box_height = 17, cell_gap = 14;

/// The part of a block that its schematic shows.
struct Shown {
    std::size_t first_row = 0, first_column = 0;
    std::size_t rows = 0, columns = 0, levels = 0;
};

/// The longer side gives way first, so that a narrow block is shown over its whole length.
Shown shown_part(const Subject& subject) {
    const Block& block = subject.block;
    const PictureRequest& request = subject.request;
    Shown shown{request.first_row, request.first_column, std::min(most_shown, request.rows_of(block.rows())),
                std::min(most_shown, request.columns_of(block.columns())),
                std::clamp<std::size_t>(block.height(), 1, SliceMap::most_levels)};
    const auto is_too_much = [&] {
        const std::size_t stacks = shown.rows * shown.columns;
        return stacks > most_shown_stacks || stacks * shown.levels > most_shown_slots;
    };
    while (is_too_much() && std::max(shown.rows, shown.columns) > 2)
        --(shown.rows > shown.columns ? shown.rows : shown.columns);
    return shown;
}

/// The schematic in space.
class Schematic {
  public:
    Schematic(const Subject& subject, const YarnColours& colours, const WeftRuns& runs, const Shown& shown)
        : m_subject(subject),
          m_colours(colours),
          m_runs(runs),
          m_shown(shown),
          m_scale(shown.rows * shown.columns <= 16   ? 84
                  : shown.rows * shown.columns <= 64 ? 62
                                                     : 48),
          m_view(m_scale),
          m_pieces(shown.rows * shown.columns <= 36 ? 6 : 4) {
        for (std::size_t column = 0; column < shown.columns; ++column) add_line(View::warp_slice, column);
        for (std::size_t row = 0; row < shown.rows; ++row) add_line(View::weft_slice, row);
        if (runs.wraparound()) add_turns();
    }

    /// Size of the picture; afterwards it begins at the given place.
    Point place_at(Point corner) {
        const auto rows = static_cast<double>(m_shown.rows), columns = static_cast<double>(m_shown.columns);
        double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
        for (const double x : {-1.5, rows + 0.5}) {
            for (const double y : {-2.1, columns + 0.5}) {
                for (const double z : {base_level, static_cast<double>(m_shown.levels)}) {
                    const Point point = m_view.on_screen({x, y, z});
                    left = std::min(left, point.x), right = std::max(right, point.x);
                    top = std::min(top, point.y), bottom = std::max(bottom, point.y);
                }
            }
        }
        m_view.move_origin({corner.x - left, corner.y - top});
        m_bottom_left = {corner.x + 8, corner.y + bottom - top};
        return {right - left, bottom - top};
    }

    void draw(Canvas& canvas) const {
        draw_base(canvas);
        draw_tubes(canvas, m_view, m_tubes);
        draw_labels(canvas);
        draw_ground_marks(canvas);
        draw_axes(canvas);
    }

  private:
    /// A number that would cover one drawn before it is left out: half a number misleads.
    void draw_labels(Canvas& canvas) const {
        std::vector<Rectangle> taken;
        for (const GroundMark& mark : ground_marks()) taken.push_back(mark.box());
        for (const Label& label : m_labels) {
            const Point middle = m_view.on_screen(label.place);
            const double half = Canvas::text_width(label.text, 12, true) / 2 + 2;
            const Rectangle box{middle.x - half, middle.y - 7, 2 * half, 14};
            const auto covers = [&](const Rectangle& other) {
                return box.x < other.x + other.width && other.x < box.x + box.width &&
                       box.y < other.y + other.height && other.y < box.y + box.height;
            };
            if (std::ranges::any_of(taken, covers)) continue;
            taken.push_back(box);
            canvas.rectangle(box, {0xff, 0xff, 0xff}, 0.8);
            canvas.text(middle, label.text,
                        {.size = 12,
                         .colour = label.colour,
                         .anchor = Anchor::middle,
                         .bold = true,
                         .centred = true});
        }
    }

    struct Label {
        Place place;
        std::string text;
        Colour colour;
    };

    /// Along a yarn: `along` counts stacks, `aside` is how far it has stepped out of its line.
    [[nodiscard]] static Place place_on(bool warp, std::size_t line, double along, double aside,
                                        double level) {
        const double across = static_cast<double>(line) + aside;
        return warp ? Place{along, across, level} : Place{across, along, level};
    }

    void add_line(View view, std::size_t line) {
        Subject subject = m_subject;
        subject.request.view = view;
        subject.request.line = line + (view == View::warp_slice ? m_shown.first_column : m_shown.first_row);
        const SliceMap map = slice_map(subject, m_colours, m_runs);
        const bool warp = view == View::warp_slice;
        const std::size_t shown = warp ? m_shown.rows : m_shown.columns;
        for (const SlicePath& path : map.paths) {
            if (path.first >= shown) continue;
            add_path(map, path, warp, line, shown);
        }
    }

    [[nodiscard]] double radius() const { return m_scale * 0.088; }

    void add_path(const SliceMap& map, const SlicePath& path, bool warp, std::size_t line,
                  std::size_t shown) {
        const std::size_t last = std::min(path.last(), shown - 1);
        for (std::size_t position = path.first; position < last; ++position)
            add_step(map, path, warp, line, position);
        const std::size_t from = path.first, to = last - path.first;
        if (!turns_at(path, warp, Side::left)) {
            add_end(path, warp, line, static_cast<double>(from), -1, 0);
        }
        if (last < path.last() || !turns_at(path, warp, Side::right)) {
            add_end(path, warp, line, static_cast<double>(last), 1, to);
        }
    }

    [[nodiscard]] bool turns_at(const SlicePath& path, bool warp, Side side) const {
        if (warp || !m_runs.wraparound()) return false;
        return std::ranges::any_of(m_runs.turns(), [&](const Turn& turn) {
            const std::size_t column = m_runs.column_of(turn);
            return turn.side == side && column >= m_shown.first_column &&
                   column < m_shown.first_column + m_shown.columns &&
                   (turn.from_pick == path.number || turn.to_pick == path.number);
        });
    }

    void add_tube(const SlicePath& path, std::vector<Place> places, bool loose, std::size_t level) {
        if ((loose && m_subject.request.trim) || level >= m_shown.levels) return;
        const Colour colour = loose ? mix(path.colour, {0xff, 0xff, 0xff}, 0.62) : path.colour;
        m_tubes.push_back({std::move(places), colour, loose ? radius() * 0.8 : radius(), 0});
    }

    /// The yarn from one stack to the next: level along its line, then smoothly to the next level, then level
    /// again.
    void add_step(const SliceMap& map, const SlicePath& path, bool warp, std::size_t line,
                  std::size_t position) {
        const std::size_t k = position - path.first;
        const auto low = static_cast<double>(path.levels[k]), high = static_cast<double>(path.levels[k + 1]);
        const double aside = swaps(map, path, k) ? path.shift * 0.5 : 0;
        const auto at = [&](double t) {
            const double rise = std::clamp((t - 0.12) / 0.76, 0.0, 1.0),
                         smooth = rise * rise * (3 - 2 * rise);
            const double bow = std::sin(std::numbers::pi * t);
            return place_on(warp, line, static_cast<double>(position) + t, aside * bow * bow,
                            low + (high - low) * smooth);
        };
        for (std::size_t piece = 0; piece < m_pieces; ++piece) {
            std::vector<Place> places;
            for (int sample = 0; sample <= 4; ++sample) {
                places.push_back(
                    at((static_cast<double>(piece) + sample / 4.0) / static_cast<double>(m_pieces)));
            }
            const bool first_half = 2 * piece < m_pieces;
            add_tube(path, std::move(places), path.loose[first_half ? k : k + 1],
                     path.levels[first_half ? k : k + 1]);
        }
    }

    /// The stub beyond the first or last stack, with the yarn's number.
    void add_end(const SlicePath& path, bool warp, std::size_t line, double from, double way, std::size_t k) {
        // A yarn without a turn runs to the edge even when its last stack lies further in.
        const double edge =
            way < 0 ? -overhang : static_cast<double>(warp ? m_shown.rows : m_shown.columns) - 1 + overhang;
        const auto level = static_cast<double>(path.levels[k]);
        const auto pieces = std::max(2.0, std::round(std::abs(edge - from) * 4));
        for (double piece = 0; piece < pieces; ++piece) {
            std::vector<Place> places;
            for (int sample = 0; sample <= 2; ++sample) {
                places.push_back(
                    place_on(warp, line, from + (edge - from) * (piece + sample / 2.0) / pieces, 0, level));
            }
            add_tube(path, std::move(places), path.loose[k], path.levels[k]);
        }
        if ((path.loose[k] && m_subject.request.trim) || path.levels[k] >= m_shown.levels) return;
        // The far ends of a thick block lie behind its yarns, where numbers would only be in the way.
        const bool near = warp == (way < 0);
        if (!near && m_shown.levels > 3) return;
        m_labels.push_back({place_on(warp, line, edge + way * 0.24, 0, level),
                            std::to_string(path.number + 1), readable(path.colour)});
    }

    /// Level and row of a pick at a column, if it lies in the shown part.
    [[nodiscard]] std::optional<Place> place_of(std::size_t pick, std::size_t column) const {
        const Block& block = m_subject.block;
        const std::size_t row = block.row_of_pick(pick);
        if (row < m_shown.first_row || row >= m_shown.first_row + m_shown.rows ||
            column < m_shown.first_column || column >= m_shown.first_column + m_shown.columns) {
            return std::nullopt;
        }
        const std::size_t level =
            block.stack(row, column).positions(System::weft)[pick - block.first_pick(row)];
        if (level >= m_shown.levels) return std::nullopt;
        return Place{static_cast<double>(row - m_shown.first_row),
                     static_cast<double>(column - m_shown.first_column), static_cast<double>(level)};
    }

    /// Half circles round the end that catches each loop.
    void add_turns() {
        for (const Turn& turn : m_runs.turns()) {
            const std::size_t column = m_runs.column_of(turn);
            const auto a = place_of(turn.from_pick, column), b = place_of(turn.to_pick, column);
            if (!a || !b) continue;
            const double out = turn.side == Side::right ? 1 : -1, reach = 0.5 + 0.07 * std::abs(a->z - b->z);
            SlicePath path;
            path.colour = m_colours.shaded_pick(turn.from_pick);
            if (turn.caught_by == CaughtBy::none) path.colour = mix(path.colour, {0, 0, 0}, 0.6);
            m_labels.push_back({{(a->x + b->x) / 2, a->y + out * (reach + 0.4), (a->z + b->z) / 2},
                                std::to_string(turn.from_pick + 1) + "→" + std::to_string(turn.to_pick + 1),
                                readable(path.colour)});
            for (int piece = 0; piece < 8; ++piece) {
                std::vector<Place> places;
                for (int sample = 0; sample <= 3; ++sample) {
                    const double angle = std::numbers::pi * (piece + sample / 3.0) / 8,
                                 share = (1 - std::cos(angle)) / 2;
                    places.push_back({a->x + (b->x - a->x) * share, a->y + out * reach * std::sin(angle),
                                      a->z + (b->z - a->z) * share});
                }
                add_tube(path, std::move(places), false, 0);
            }
        }
    }

    void draw_base(Canvas& canvas) const {
        const double x = static_cast<double>(m_shown.rows) - 0.5,
                     y = static_cast<double>(m_shown.columns) - 0.5;
        const auto ground = [&](double px, double py) { return m_view.on_screen({px, py, base_level}); };
        const Point corners[]{ground(-0.5, -0.5), ground(x, -0.5), ground(x, y), ground(-0.5, y)};
        canvas.polygon(corners, {0xf3, 0xf5, 0xf7});
        std::vector<Point> lines;
        for (double row = -0.5; row <= x; ++row)
            lines.insert(lines.end(), {ground(row, -0.5), ground(row, y)});
        for (double column = -0.5; column <= y; ++column)
            lines.insert(lines.end(), {ground(-0.5, column), ground(x, column)});
        canvas.lines(lines, {.colour = {0xc4, 0xcb, 0xd2}, .width = 1, .round = false});
    }

    /// An arrow on the ground that points along the first pick or end shown, beyond the numbers of the yarns.
    struct GroundMark {
        Point tail, tip;
        std::string name;
        [[nodiscard]] Point text_end() const { return {tail.x - 5, tail.y + 3}; }
        [[nodiscard]] Rectangle box() const {
            const double left = text_end().x - Canvas::text_width(name, 11, true);
            const double top = std::min({tail.y, tip.y, text_end().y - 6}) - 3;
            return {left, top, tip.x + 4 - left, std::max({tail.y, tip.y, text_end().y + 6}) + 3 - top};
        }
    };

    [[nodiscard]] std::vector<GroundMark> ground_marks() const {
        const Block& block = m_subject.block;
        const auto mark = [&](Place tail, Place tip, const char* yarn, std::size_t number) {
            return GroundMark{m_view.on_screen(tail), m_view.on_screen(tip),
                              yarn + std::to_string(number + 1)};
        };
        const double tip = -0.5 - 38 / m_scale, tail = tip - 22 / m_scale;  // as far at every scale
        return {
            mark({0, tail, base_level}, {0, tip, base_level}, "pick ", block.first_pick(m_shown.first_row)),
            mark({tail, 0, base_level}, {tip, 0, base_level}, "end ", block.first_end(m_shown.first_column))};
    }

    void draw_ground_marks(Canvas& canvas) const {
        for (const GroundMark& mark : ground_marks()) {
            const Point shaft[]{mark.tail, mark.tip};
            canvas.polyline(shaft, {.colour = accent, .width = 2});
            canvas.arrow_head(mark.tip, {mark.tip.x - mark.tail.x, mark.tip.y - mark.tail.y}, 9, accent);
            canvas.text(mark.text_end(), mark.name,
                        {.size = 11, .colour = accent, .anchor = Anchor::end, .bold = true, .centred = true});
        }
    }

    void draw_axes(Canvas& canvas) const {
        Viewpoint view(38, 1);
        view.move_origin({m_bottom_left.x, m_bottom_left.y - 14});
        const Point origin = view.on_screen({0, 0, 0});
        const auto axis = [&](Place tip, const char* name, double dx, double dy) {
            const Point end = view.on_screen(tip);
            const Point shaft[]{origin, end};
            canvas.polyline(shaft, {.colour = ink, .width = 1.5});
            canvas.arrow_head(end, {end.x - origin.x, end.y - origin.y}, 8, ink);
            canvas.text({end.x + dx, end.y + dy}, name, {.size = 10.5, .colour = ink, .centred = true});
        };
        axis({1.1, 0, 0}, "x, warp", 5, -2);
        axis({0, 0.9, 0}, "y, weft", 5, 2);
        axis({0, 0, 1}, "z", 5, -2);
    }

    const Subject& m_subject;
    const YarnColours& m_colours;
    const WeftRuns& m_runs;
    Shown m_shown;
    double m_scale;  ///< pixels of one stack
    Viewpoint m_view;
    std::size_t m_pieces;
    std::vector<Tube> m_tubes;
    std::vector<Label> m_labels;
    Point m_bottom_left;
};

/// Small blocks are also written out, as in the paper: the stacks of row 0 at the bottom, every stack from
/// its bottom up.
bool is_written(const Block& block) {
    return block.rows() <= 4 && block.columns() <= 4 && block.height() <= 8 && block.picks() <= 100 &&
           block.ends() <= 100;
}

Point written_size(const Block& block) {
    return {
        static_cast<double>(block.columns()) * (box_width + cell_gap) + 44,
        static_cast<double>(block.rows()) * (box_height * static_cast<double>(block.height()) + cell_gap) +
            48};
}

void draw_written(Canvas& canvas, const Block& block, Point corner) {
    canvas.text({corner.x, corner.y + 10}, "Stacks", {.size = 12, .bold = true});
    canvas.text({corner.x, corner.y + 25}, "bottom up, picks T and ends P from 1",
                {.size = 10, .colour = faint_ink});
    const double high = box_height * static_cast<double>(block.height());
    for (std::size_t row = 0; row < block.rows(); ++row) {
        const double bottom =
            corner.y + 48 + static_cast<double>(block.rows() - row) * (high + cell_gap) - cell_gap;
        for (std::size_t column = 0; column < block.columns(); ++column) {
            const double left = corner.x + static_cast<double>(column) * (box_width + cell_gap);
            const auto slots = block.stack(row, column).slots();
            for (std::size_t k = 0; k < block.height(); ++k) {
                const Slot slot = k < slots.size() ? slots[k] : Slot{};
                const Rectangle box{left, bottom - static_cast<double>(k + 1) * box_height, box_width,
                                    box_height};
                const Colour fill =
                    slot.is_empty() ? Colour{0xff, 0xff, 0xff}
                                    : mix(slot.is_weft() ? paper_weft : paper_warp, {0xff, 0xff, 0xff}, 0.55);
                canvas.rectangle(box, fill);
                canvas.outline({box.x + 0.5, box.y + 0.5, box.width, box.height},
                               {.colour = {0x70, 0x76, 0x7d}, .width = 1, .round = false});
                const std::string word = slot.is_empty() ? "E"
                                                         : to_text(Stack({slot}), block.first_pick(row) + 1,
                                                                   block.first_end(column) + 1);
                canvas.text({box.x + box_width / 2 + 0.5, box.y + box_height / 2 + 0.5}, word,
                            {.size = 10.5,
                             .colour = slot.is_empty() ? Colour{0xb0, 0xb4, 0xb8} : ink,
                             .anchor = Anchor::middle,
                             .centred = true});
            }
        }
    }
}

/// Says which part of the block is shown, where it is not the whole.
void add_shown(PageText& text, const Block& block, const Shown& shown) {
    std::string words;
    const auto add = [&](const std::string& part) { words += (words.empty() ? "" : ", ") + part; };
    const auto add_range = [&](const char* name, std::size_t first, std::size_t count, std::size_t all) {
        if (count == all) return;
        add(name + std::string(" ") + std::to_string(first + 1) + "–" + std::to_string(first + count) +
            " of " + std::to_string(all));
    };
    add_range("rows", shown.first_row, shown.rows, block.rows());
    add_range("columns", shown.first_column, shown.columns, block.columns());
    if (shown.levels < block.height()) {
        add("the lowest " + std::to_string(shown.levels) + " of " + std::to_string(block.height()) +
            " levels");
    }
    if (!words.empty()) text.notes.push_back("Shown: " + words + ".");
}

PageText block_words(const Subject& subject, const Shown& shown, const WeftRuns& runs) {
    const Block& block = subject.block;
    PageText text = words_of(subject, std::string("block, schematic of the stacks, face up, weft ") +
                                          (runs.wraparound() ? "wraparound" : "periodic"));
    add_shown(text, block, shown);
    text.notes.emplace_back(
        "Numbers at the yarns count picks and ends from 1, as on the card; where they would overlap, some "
        "are "
        "left out. Ground squares are stacks.");
    if (subject.request.trim) {
        text.notes.emplace_back("Trimmed: yarns that are loose on purpose are left out.");
    } else if (std::ranges::any_of(block.stacks(), has_loose)) {
        text.notes.emplace_back("Pale and thin: loose on purpose.");
    }
    return text;
}

}  // namespace

Result<std::string> draw_block(const Subject& subject) {
    const YarnColours colours(subject);
    const WeftRuns runs(subject, colours);
    const Shown shown = shown_part(subject);
    Schematic schematic(subject, colours, runs, shown);
    const Point size = schematic.place_at({Page::margin, Page::body_top});
    const bool written = is_written(subject.block);
    const Point table = written ? written_size(subject.block) : Point{};
    const double table_width = written ? std::max(table.x, 230.0) + 24 : 0;
    WEAVE_TRY(Page page, Page::open(subject, block_words(subject, shown, runs), size.x + table_width,
                                    std::max(size.y, table.y)));
    schematic.draw(page.canvas);
    if (written)
        draw_written(page.canvas, subject.block,
                     {Page::margin + size.x + 24, Page::body_top + std::max(0.0, (size.y - table.y) / 2)});
    return std::move(page.canvas).finish();
}

}  // namespace weave
