#include <weave/picture/label_places.hpp>
#include <weave/picture/slice_map.hpp>
#include <weave/picture/views.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace weave {

namespace {

constexpr double dot_radius = 10, path_width = 5;
constexpr Colour grid_ink{0xd4, 0xd8, 0xdc}, uncaught_ink{0x11, 0x11, 0x11};

/// The drawer of one slice.
class SliceDrawer {
  public:
    /// `first_yarn` is the pick or end with which the shown part begins.
    SliceDrawer(Canvas& canvas, const SliceMap& map, std::size_t first_yarn, bool trim)
        : m_canvas(canvas), m_map(map), m_places(around(map)), m_first_yarn(first_yarn), m_trim(trim) {}

    void draw() {
        draw_grid();
        const double rim = dot_radius + 6;
        const Point low = at(-1.9, -0.5), high = at(static_cast<double>(m_map.positions) + 0.9,
                                                    static_cast<double>(m_map.levels) - 0.5);
        m_canvas.clip({low.x, high.y - rim, high.x - low.x, low.y - high.y + 2 * rim});
        for (const SlicePath& path : m_map.paths) draw_path(path, true);
        draw_turns();
        for (const SlicePath& path : m_map.paths) draw_path(path, false);
        for (const SliceDot& dot : m_map.dot_list) draw_dot(dot);
        for (const SlicePath& path : m_map.paths) draw_names(path);
        m_canvas.unclip();
        for (WayOut& way : m_ways_out) draw_stub(way);
        for (const WayOut& way : m_ways_out) draw_name(way);
    }

  private:
    struct Piece {
        std::vector<Point> bezier;
        bool loose = false;
    };

    /// The part of the picture in which words may stand.
    static Rectangle around(const SliceMap& map) {
        const Point low = slice_point(map, 0, 0), high = slice_point(map, static_cast<double>(map.positions),
                                                                     static_cast<double>(map.levels));
        return {4, high.y - 4, high.x + 56, low.y - high.y + 28};
    }

    [[nodiscard]] Point at(double position, double level) const {
        return slice_point(m_map, position, level);
    }

    void draw_grid() {
        const auto positions = static_cast<double>(m_map.positions),
                   levels = static_cast<double>(m_map.levels);
        std::vector<Point> lines;
        for (std::size_t k = 0; k < m_map.levels; ++k) {
            const auto level = static_cast<double>(k);
            lines.insert(lines.end(), {at(-0.4, level), at(positions - 0.6, level)});
        }
        for (std::size_t k = 0; k < m_map.positions; ++k) {
            const auto position = static_cast<double>(k);
            lines.insert(lines.end(), {at(position, -0.4), at(position, levels - 0.6)});
            Point name = at(position, 0);
            name.y += 34;
            m_canvas.text(name, std::to_string(m_map.begin + k + 1),
                          {.size = 10, .colour = faint_ink, .anchor = Anchor::middle});
        }
        m_canvas.lines(lines, {.colour = grid_ink, .width = 1, .round = false});
        const bool rows = m_map.dots == System::weft;
        Point from = at(0, 0);
        from.y += 48;
        const Point axis[]{{from.x, from.y}, {from.x + 22, from.y}};
        m_canvas.polyline(axis, {.colour = accent, .width = 2});
        m_canvas.arrow_head({axis[1].x + 6, from.y}, {1, 0}, 8, accent);
        m_canvas.text({axis[1].x + 12, from.y},
                      (rows ? "rows, from pick " : "columns, from end ") + std::to_string(m_first_yarn + 1) +
                          (rows ? " (along the warp)" : " (along the weft)"),
                      {.size = 11, .colour = accent, .bold = true, .centred = true});
        const Point corner{at(0, 0).x - 96, at(0, 0).y};
        const Point height[]{corner, {corner.x, corner.y - 16}};
        m_canvas.polyline(height, {.colour = accent, .width = 2});
        m_canvas.arrow_head({corner.x, corner.y - 22}, {0, -1}, 8, accent);
        m_canvas.text({corner.x - 4, corner.y + 16}, "face up", {.size = 11, .colour = accent, .bold = true});
    }

    /// Bézier points from level k of the path to the next, the first point left out.
    [[nodiscard]] std::array<Point, 4> step(const SlicePath& path, std::size_t k) const {
        const Point a = at(static_cast<double>(path.first + k), static_cast<double>(path.levels[k]));
        const Point b = at(static_cast<double>(path.first + k + 1), static_cast<double>(path.levels[k + 1]));
        const double reach = (b.x - a.x) * 0.5,
                     aside = swaps(m_map, path, k) ? path.shift * (b.x - a.x) * 0.55 : 0;
        return {a, {a.x + reach + aside, a.y}, {b.x - reach + aside, b.y}, b};
    }

    static std::pair<std::array<Point, 4>, std::array<Point, 4>> halves(const std::array<Point, 4>& c) {
        const auto middle = [](Point a, Point b) { return Point{(a.x + b.x) / 2, (a.y + b.y) / 2}; };
        const Point ab = middle(c[0], c[1]), bc = middle(c[1], c[2]), cd = middle(c[2], c[3]);
        const Point abc = middle(ab, bc), bcd = middle(bc, cd), all = middle(abc, bcd);
        return {{c[0], ab, abc, all}, {all, bcd, cd, c[3]}};
    }

    void append(std::vector<Piece>& pieces, const std::array<Point, 4>& bezier, bool loose) const {
        if (pieces.empty() || pieces.back().loose != loose) pieces.push_back({{bezier[0]}, loose});
        pieces.back().bezier.insert(pieces.back().bezier.end(), bezier.begin() + 1, bezier.end());
    }

    static std::array<Point, 4> straight(Point a, Point b) {
        return {a, {a.x + (b.x - a.x) / 3, a.y}, {a.x + (b.x - a.x) * 2 / 3, b.y}, b};
    }

    [[nodiscard]] std::vector<Piece> pieces_of(const SlicePath& path) const {
        std::vector<Piece> pieces;
        const auto first = static_cast<double>(path.first), last = static_cast<double>(path.last());
        const auto low = static_cast<double>(path.levels.front()),
                   high = static_cast<double>(path.levels.back());
        if (reaches(m_map, path, Side::left))
            append(pieces, straight(at(-overhang, low), at(first, low)), path.loose.front());
        for (std::size_t k = 0; k + 1 < path.levels.size(); ++k) {
            const auto [here, next] = halves(step(path, k));
            append(pieces, here, path.loose[k]);
            append(pieces, next, path.loose[k + 1]);
        }
        if (reaches(m_map, path, Side::right)) {
            const double edge = static_cast<double>(m_map.positions) - 1 + overhang;
            append(pieces, straight(at(last, high), at(edge, high)), path.loose.back());
        }
        return pieces;
    }

    void draw_path(const SlicePath& path, bool casing) {
        for (const Piece& piece : pieces_of(path)) {
            if (piece.loose && m_trim) continue;
            Stroke stroke{.colour = path.colour, .width = path_width};
            if (casing) {
                stroke = {.colour = mix(path.colour, {0, 0, 0}, 0.45), .width = path_width + 1.6};
            }
            if (piece.loose) {
                if (casing) continue;
                stroke.dash = {2, 8};
                stroke.width = path_width - 1.5;
            }
            m_canvas.curve(piece.bezier, stroke);
            if (!casing) m_places.add_curve(piece.bezier);
        }
        if (!casing && m_map.dots == System::warp) draw_directions(path);
    }

    /// Arrow heads on the weft, in the direction of the shuttle.
    void draw_directions(const SlicePath& path) {
        const double way = path.leftwards ? -1 : 1;
        const auto mark = [&](Point point, double slope) {
            const double norm = std::hypot(1.0, slope);
            const Point ahead{way / norm, way * slope / norm};
            m_canvas.arrow_head({point.x + ahead.x * 10, point.y + ahead.y * 10}, ahead, 21,
                                {0xff, 0xff, 0xff});  // a rim, so that it reads on dark yarns too
            m_canvas.arrow_head({point.x + ahead.x * 7, point.y + ahead.y * 7}, ahead, 14,
                                mix(path.colour, {0, 0, 0}, 0.62));
            m_places.add_disc(point, dot_radius);
        };
        for (const std::size_t k : arrow_places(m_map, path, m_trim)) {
            const auto curve = halves(step(path, k));
            const Point tip = curve.second[0], before = curve.first[2];
            mark(tip, tip.x == before.x ? 0 : (tip.y - before.y) / (tip.x - before.x));
        }
    }

    void draw_dot(const SliceDot& dot) {
        const Point centre = at(static_cast<double>(dot.position), static_cast<double>(dot.level));
        const Colour rim = mix(dot.colour, {0, 0, 0}, 0.45),
                     fill = dot.loose ? mix(dot.colour, {0xff, 0xff, 0xff}, 0.7) : dot.colour;
        m_places.add_disc(centre, dot_radius + 1);
        m_canvas.circle(centre, dot_radius, fill);
        m_canvas.ring(centre, dot_radius,
                      {.colour = rim,
                       .width = 1.3,
                       .dash = dot.loose ? std::vector<double>{2.5, 3} : std::vector<double>{}});
        const std::string number = std::to_string(dot.number + 1);
        const double size = number.size() <= 2 ? 10.5 : number.size() == 3 ? 8.5 : 6.5;
        m_canvas.text(
            centre, number,
            {.size = size, .colour = ink_on(fill), .anchor = Anchor::middle, .bold = true, .centred = true});
    }

    /// The number on the yarn itself.
    void draw_tag(const SlicePath& path, double position, std::size_t k) {
        if (path.levels[k] >= m_map.levels || (m_trim && path.loose[k])) return;
        const std::string number = std::to_string(path.number + 1);
        const Point middle = at(position, static_cast<double>(path.levels[k]));
        const double half = Canvas::text_width(number, 11, true) / 2 + 2;
        const Rectangle tag{middle.x - half, middle.y - 7, 2 * half, 14};
        m_places.add_words(tag);
        m_canvas.rectangle(tag, {0xff, 0xff, 0xff}, 0.9);
        m_canvas.text(middle, number,
                      {.size = 11,
                       .colour = readable(path.colour),
                       .anchor = Anchor::middle,
                       .bold = true,
                       .centred = true});
    }

    /// A pick's number stands at the edges it runs to, on the yarn where it turns, and so often along a long
    /// way that it can be followed, in another place on each yarn.
    void draw_names(const SlicePath& path) {
        const std::string number = std::to_string(path.number + 1);
        const auto name = [&](double position, std::size_t level, Anchor anchor) {
            if (level >= m_map.levels) return;
            const Point place = at(position, static_cast<double>(level));
            const double width = Canvas::text_width(number, 11, true);
            m_places.add_words({anchor == Anchor::start ? place.x : place.x - width, place.y - 6, width, 12});
            m_canvas.text(place, number,
                          {.size = 11,
                           .colour = readable(path.colour),
                           .anchor = anchor,
                           .bold = true,
                           .centred = true});
        };
        const double edge = static_cast<double>(m_map.positions) - 1;
        const std::size_t last = path.levels.size() - 1;
        if (!reaches(m_map, path, Side::left)) {
            draw_tag(path, static_cast<double>(path.first) + (last == 0 ? 0 : 0.2), 0);
        } else if (!(m_trim && path.loose.front())) {
            name(-overhang - 0.14, path.levels.front(), Anchor::end);
        }
        if (!reaches(m_map, path, Side::right)) {
            if (last > 1) draw_tag(path, static_cast<double>(path.last()) - 0.2, last);
        } else if (!(m_trim && path.loose.back())) {
            name(edge + overhang + 0.14, path.levels.back(), Anchor::start);
        }
        for (std::size_t k = 4 + 3 * (path.number % 3); k + 6 < path.levels.size(); k += 10)
            draw_tag(path, static_cast<double>(path.first + k), k);
    }

    /// Wide turns go round narrow ones.
    void draw_turns() {
        struct Arc {
            const SliceTurn* shown;
            double low, high;
            std::size_t inside = 0;  ///< turns that it goes round
        };
        std::vector<Arc> arcs;
        for (const SliceTurn& shown : m_map.turns) {
            if (!shown.stays()) {
                add_way_out(shown);
                continue;
            }
            const Side side = shown.turn.side;
            const double a = end_of(m_map.paths[*shown.from], side).y,
                         b = end_of(m_map.paths[*shown.to], side).y;
            arcs.push_back({&shown, std::min(a, b), std::max(a, b)});
        }
        std::ranges::stable_sort(arcs, {}, [](const Arc& arc) { return arc.high - arc.low; });
        for (std::size_t k = 0; k < arcs.size(); ++k) {
            for (std::size_t j = 0; j < k; ++j) {
                const bool meet = arcs[j].shown->turn.side == arcs[k].shown->turn.side &&
                                  arcs[j].low < arcs[k].high && arcs[k].low < arcs[j].high;
                if (meet) arcs[k].inside = std::max(arcs[k].inside, arcs[j].inside + 1);
            }
            draw_turn(*arcs[k].shown, arcs[k].inside);
        }
    }

    [[nodiscard]] Point end_of(const SlicePath& path, Side side) const {
        return side == Side::right
                   ? at(static_cast<double>(path.last()), static_cast<double>(path.levels.back()))
                   : at(static_cast<double>(path.first), static_cast<double>(path.levels.front()));
    }

    void draw_turn(const SliceTurn& shown, std::size_t inside) {
        const SlicePath &from = m_map.paths[*shown.from], &to = m_map.paths[*shown.to];
        const Side side = shown.turn.side;
        const Point a = end_of(from, side), b = end_of(to, side);
        const double out = side == Side::right ? 1 : -1;
        const double outermost = out > 0 ? std::max(a.x, b.x) : std::min(a.x, b.x);
        const double reach =
            outermost +
            out * std::min(34 + 18.0 * static_cast<double>(inside) + std::abs(a.y - b.y) * 0.12, 86.0);
        const Point arc[]{a, {reach, a.y}, {reach, b.y}, b};
        const bool caught = shown.caught();
        const Colour colour = caught ? from.colour : uncaught_ink;
        m_canvas.curve(arc, {.colour = mix(colour, {0, 0, 0}, 0.45),
                             .width = path_width + 1.6,
                             .dash = caught ? std::vector<double>{} : std::vector<double>{3, 8}});
        m_places.add_curve(arc);
        if (caught) m_canvas.curve(arc, {.colour = colour, .width = path_width});
        const Point middle{(a.x + b.x + 6 * reach) / 8, (a.y + b.y) / 2};
        const double down = b.y > a.y ? 1 : -1;
        m_canvas.arrow_head({middle.x, middle.y + down * 7}, {0, down}, 14, mix(colour, {0, 0, 0}, 0.62));
    }

    struct WayOut {
        Point end;                  ///< of the yarn as drawn
        double out = 1;             ///< 1 to the right, -1 to the left
        std::string number, words;  ///< of the yarn; where it goes or comes from
        Colour colour;
        bool leaves = false;  ///< the shuttle, rather than comes in
        bool caught = true;   ///< every turn beyond
        double start = 0;  ///< of its line from the end: beyond the tag of a yarn that is nothing but an end
        Point tip{};       ///< of the stub
    };

    /// Where the drawn part of a path ends; nothing where all of it is trimmed off.
    [[nodiscard]] std::optional<Point> drawn_end(const SlicePath& path, Side side) const {
        if (!m_trim) return end_of(path, side);
        const std::size_t last = path.levels.size() - 1;
        for (std::size_t steps = 0; steps <= last; ++steps) {
            const std::size_t k = side == Side::right ? last - steps : steps;
            if (path.loose[k]) continue;
            if (steps == 0) return end_of(path, side);
            return halves(step(path, side == Side::right ? k : k - 1)).second[0];
        }
        return std::nullopt;
    }

    /// A turn whose other pick lies in another row: the yarn leaves the slice, with the number of where it
    /// goes or comes from. Where two feeders do so at one end of a pick, the words say both.
    void add_way_out(const SliceTurn& shown) {
        const Turn& turn = shown.turn;
        const bool leaves = shown.from.has_value();
        const SlicePath& path = m_map.paths[leaves ? *shown.from : *shown.to];
        const std::optional<Point> end = drawn_end(path, turn.side);
        if (!end) return;
        const std::string words = (leaves ? "to " : "from ") +
                                  std::to_string((leaves ? turn.to_pick : turn.from_pick) + 1) +
                                  (shown.caught() ? "" : " (not caught)");
        const double out = turn.side == Side::right ? 1 : -1;
        const auto known = std::ranges::find_if(m_ways_out, [&](const WayOut& way) {
            return way.out == out && way.end.x == end->x && way.end.y == end->y;
        });
        if (known == m_ways_out.end()) {
            const std::string number = std::to_string(path.number + 1);
            const bool point = path.levels.size() == 1;
            const double start = point ? Canvas::text_width(number, 11, true) / 2 + 3 : 0;
            m_ways_out.push_back({*end, out, number, words, path.colour, leaves, shown.caught(), start});
        } else {
            known->words += ", " + words;
            known->leaves = known->leaves || leaves;
            known->caught = known->caught && shown.caught();
        }
    }

    static constexpr double stub_reach = 32, widest_turn = 66;  ///< from the end of the yarn

    /// A short dotted line out of the yarn's end: shorter or tilted where it would run into something.
    void draw_stub(WayOut& way) {
        constexpr double begin = 14;  // from here on the line is clear of its own yarn and tag
        constexpr double clear = 8;   // before the tip, which shall point at no other yarn
        double least = std::numeric_limits<double>::infinity();
        Point ahead{};
        for (const double angle : {0.0, 0.5, -0.5, 0.9, -0.9, 1.25, -1.25}) {
            for (const double reach : {stub_reach, 23.0}) {
                const Point along{way.out * std::cos(angle), -std::sin(angle)};
                const Point tip{way.end.x + along.x * reach, way.end.y + along.y * reach};
                const Point beyond{tip.x + along.x * clear, tip.y + along.y * clear};
                const double harm =
                    m_places.harm_along({way.end.x + along.x * begin, way.end.y + along.y * begin}, beyond);
                if (harm >= least) continue;
                least = harm, way.tip = tip, ahead = along;
            }
        }
        const double head = way.leaves ? 8 : 0;
        const Point stub[]{{way.end.x + ahead.x * way.start, way.end.y + ahead.y * way.start},
                           {way.tip.x - ahead.x * head, way.tip.y - ahead.y * head}};
        const Colour line = way.caught ? mix(way.colour, {0, 0, 0}, 0.3) : uncaught_ink;
        m_canvas.polyline(stub, {.colour = line, .width = 2, .dash = {1, 4}});
        if (way.leaves) m_canvas.arrow_head(way.tip, ahead, 9, mix(way.colour, {0, 0, 0}, 0.5));
        m_places.add_curve(straight(way.end, way.tip));
    }

    /// Where the words of a way out would best stand, the best first: at its tip, beyond the turns of other
    /// yarns, or in the gaps between the dots above and below.
    [[nodiscard]] std::vector<Point> wishes(const WayOut& way, double width, double height) const {
        const double level = at(0, 0).y - at(0, 1).y, gap = (at(1, 0).x - at(0, 0).x) / 2;
        const double beyond = widest_turn + 4 + width / 2;
        const bool upwards = way.tip.y<way.end.y - 1, downwards = way.tip.y> way.end.y + 1;
        std::vector<Point> places{{way.tip.x + way.out * (4 + width / 2), way.tip.y}};
        if (!downwards) places.push_back({way.tip.x, way.tip.y - height / 2 - 6});
        if (!upwards) places.push_back({way.tip.x, way.tip.y + height / 2 + 6});
        for (const double up : {0.0, 0.5, -0.5, 1.0, -1.0, 1.5, -1.5, 2.5, -2.5}) {
            if (up != 0) {
                places.push_back({way.end.x + way.out * gap, way.end.y - up * level});
                places.push_back({way.tip.x + way.out * (4 + width / 2), way.tip.y - up * level});
            }
            places.push_back({way.end.x + way.out * beyond, way.end.y - up * level});
        }
        return places;
    }

    /// The words where they hide nothing, with a line to the tip where they stand away from it. They begin
    /// with the yarn's own number if there is room for it.
    void draw_name(const WayOut& way) {
        constexpr double size = 10;
        const auto width_of = [&](const std::string& words) { return Canvas::text_width(words, size) + 2; };
        std::string words = way.number + " " + way.words;
        if (!m_places.fits(width_of(words), size, wishes(way, width_of(words), size))) words = way.words;
        const double width = width_of(words);
        const Rectangle place = m_places.take(width, size, wishes(way, width, size));
        const Point middle{place.x + place.width / 2, place.y + place.height / 2};
        const Point near{std::clamp(way.tip.x, place.x, place.x + place.width),
                         std::clamp(way.tip.y, place.y, place.y + place.height)};
        if (std::hypot(near.x - way.tip.x, near.y - way.tip.y) > size) {
            const Point leader[]{way.tip, near};
            m_canvas.polyline(leader, {.colour = faint_ink, .width = 0.8, .dash = {1, 3}});
        }
        m_canvas.rectangle(place, {0xff, 0xff, 0xff}, 0.8);
        m_canvas.text(middle, words,
                      {.size = size, .colour = faint_ink, .anchor = Anchor::middle, .centred = true});
    }

    Canvas& m_canvas;
    const SliceMap& m_map;
    LabelPlaces m_places;
    std::size_t m_first_yarn;
    std::vector<WayOut> m_ways_out;
    bool m_trim;
};

std::string range(const char* one, const char* many, std::size_t first, std::size_t after) {
    if (after - first == 1) return std::string(one) + " " + std::to_string(first + 1);
    return std::string(many) + " " + std::to_string(first + 1) + "–" + std::to_string(after);
}

/// Says which part of the slice is shown, where it is not the whole.
void add_shown(PageText& text, const Block& block, const SliceMap& map) {
    const bool rows = map.dots == System::weft;
    const std::size_t after = map.begin + map.positions;
    std::string words;
    if (map.positions < map.all_positions) {
        words = range(rows ? "row" : "column", rows ? "rows" : "columns", map.begin, after) + " of " +
                std::to_string(map.all_positions) + ", " +
                (rows ? range("pick", "picks", block.first_pick(map.begin), block.first_pick(after))
                      : range("end", "ends", block.first_end(map.begin), block.first_end(after)));
    }
    if (map.levels < map.all_levels) {
        words += (words.empty() ? "the lowest " : "; the lowest ") + std::to_string(map.levels) + " of " +
                 std::to_string(map.all_levels) + " levels";
    }
    if (!words.empty()) text.notes.push_back("Shown: " + words + ".");
}

/// Whether a turn is drawn, or the way out to it: not where its yarn is trimmed off.
bool is_drawn(const SliceMap& map, const SliceTurn& shown, bool trim) {
    const SlicePath& path = map.paths[shown.from ? *shown.from : *shown.to];
    return shown.stays() || !trim || std::ranges::find(path.loose, false) != path.loose.end();
}

bool has_arrows(const SliceMap& map, bool trim) {
    return std::ranges::any_of(
               map.paths, [&](const SlicePath& path) { return !arrow_places(map, path, trim).empty(); }) ||
           std::ranges::any_of(
               map.turns, [&](const SliceTurn& shown) { return shown.from && is_drawn(map, shown, trim); });
}

PageText slice_words(const Subject& subject, const SliceMap& map, const WeftRuns& runs) {
    const Block& block = subject.block;
    const std::size_t line = subject.request.line;
    const bool warps_run = map.dots == System::weft, trim = subject.request.trim;
    const std::string place = std::to_string(line + 1);
    PageText text = words_of(
        subject, warps_run ? "warp slice, column " + place + ": " +
                                 range("end", "ends", block.first_end(line), block.first_end(line + 1))
                           : "weft slice, row " + place + ": " +
                                 range("pick", "picks", block.first_pick(line), block.first_pick(line + 1)) +
                                 (runs.wraparound() ? ", wraparound" : ", periodic"));
    add_shown(text, block, map);
    text.notes.push_back(warps_run
                             ? "Dots: wefts with their pick numbers. Lines: warps with their end numbers."
                             : std::string("Dots: warps with their end numbers. Lines: wefts with their pick "
                                           "numbers") +
                                   (has_arrows(map, trim) ? "; arrows show the way of the shuttle." : "."));
    const auto loose = [](const SlicePath& path) {
        return std::ranges::find(path.loose, true) != path.loose.end();
    };
    if (trim) {
        text.notes.emplace_back("Trimmed: yarns that are loose on purpose are left out.");
    } else if (std::ranges::any_of(map.paths, loose) || std::ranges::any_of(map.dot_list, &SliceDot::loose)) {
        text.notes.emplace_back("Dotted: loose on purpose.");
    }
    const auto uncaught = [&](const SliceTurn& shown) {
        return !shown.caught() && is_drawn(map, shown, trim);
    };
    if (std::ranges::any_of(map.turns, uncaught))
        text.notes.emplace_back("Black dotted turns are not caught.");
    return text;
}

}  // namespace

Result<std::string> draw_slice(const Subject& subject) {
    const YarnColours colours(subject);
    const WeftRuns runs(subject, colours);
    const SliceMap map = slice_map(subject, colours, runs);
    const Point origin = slice_point(map, 0, 0),
                far = slice_point(map, static_cast<double>(map.positions), static_cast<double>(map.levels));
    WEAVE_TRY(Page page, Page::open(subject, slice_words(subject, map, runs), far.x + 40 - Page::margin,
                                    origin.y - Page::body_top + 58));
    const std::size_t first_yarn =
        map.dots == System::weft ? subject.block.first_pick(map.begin) : subject.block.first_end(map.begin);
    SliceDrawer(page.canvas, map, first_yarn, subject.request.trim).draw();
    return std::move(page.canvas).finish();
}

}  // namespace weave
