#include <weave/samples/shoe_map.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace weave::sample {

namespace {

struct Point {
    double across = 0, along = 0;
};

/// The outline of the flat shoe (a right one, seen from above) as points that a smooth closed curve runs
/// through, in columns and rows; the heel is at row 22, the toe at row 975.
constexpr std::array<Point, 27> outline{
    {{200, 22},  {262, 34},  {308, 78},  {330, 150}, {336, 240}, {330, 340}, {322, 440},
     {328, 540}, {344, 640}, {354, 730}, {350, 810}, {326, 880}, {282, 935}, {222, 968},
     {165, 975}, {112, 950}, {74, 895},  {54, 820},  {48, 730},  {56, 640},  {70, 540},
     {76, 440},  {70, 340},  {64, 240},  {70, 150},  {92, 78},   {138, 34}}};

/// A point of the Catmull-Rom curve through the outline, `t` of the way from point k to the next.
Point on_outline(std::size_t k, double t) {
    const auto point = [&](std::size_t step) {
        return outline[(k + outline.size() + step - 1) % outline.size()];
    };
    const auto curve = [t](double a, double b, double c, double d) {
        return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
    };
    const Point a = point(0), b = point(1), c = point(2), d = point(3);
    return {curve(a.across, b.across, c.across, d.across), curve(a.along, b.along, c.along, d.along)};
}

/// The columns from `left` to `right` that lie inside the outline in each row; left > right where there are
/// none.
struct Span {
    double left = shoe_columns, right = 0;
};

std::vector<Span> outline_spans() {
    constexpr std::size_t steps = 48;
    std::vector<Span> spans(shoe_rows);
    Point before = on_outline(0, 0);
    for (std::size_t k = 0; k < outline.size(); ++k) {
        for (std::size_t step = 1; step <= steps; ++step) {
            const Point here = on_outline(k, static_cast<double>(step) / steps);
            const auto [low, high] = std::minmax(before.along, here.along);
            for (auto row = static_cast<std::size_t>(std::ceil(low - 0.5));
                 static_cast<double>(row) + 0.5 <= high; ++row) {
                const double share =
                    (static_cast<double>(row) + 0.5 - before.along) / (here.along - before.along);
                const double across = before.across + share * (here.across - before.across);
                spans[row].left = std::min(spans[row].left, across);
                spans[row].right = std::max(spans[row].right, across);
            }
            before = here;
        }
    }
    return spans;
}

/// Distance to the outline in cells, positive inside, by two sweeps with steps of 3 straight and 4 aslant (a
/// third too many each). Beyond the far field it does not matter and stays at its limit.
class Distances {
  public:
    explicit Distances(const std::vector<Span>& spans) : m_inside(size), m_thirds(size, far) {
        for (std::size_t row = 0; row < shoe_rows; ++row) {
            for (std::size_t column = 0; column < shoe_columns; ++column) {
                const double middle = static_cast<double>(column) + 0.5;
                m_inside[row * shoe_columns + column] = spans[row].left < middle && middle < spans[row].right;
            }
        }
        for (std::size_t row = 0; row + 1 < shoe_rows; ++row) {
            for (std::size_t column = 0; column + 1 < shoe_columns; ++column) mark_edge(row, column);
        }
        sweep();
        std::reverse(m_thirds.begin(), m_thirds.end());
        sweep();
        std::reverse(m_thirds.begin(), m_thirds.end());
    }
    [[nodiscard]] double at(std::size_t row, std::size_t column) const {
        const std::size_t k = row * shoe_columns + column;
        const double distance = m_thirds[k] / 3.0;
        return m_inside[k] ? distance : -distance;
    }

  private:
    static constexpr std::size_t size = shoe_rows * shoe_columns;
    static constexpr int far = 3000;

    void mark_edge(std::size_t row, std::size_t column) {
        const std::size_t here = row * shoe_columns + column;
        for (const std::size_t other : {here + 1, here + shoe_columns}) {
            if (m_inside[here] != m_inside[other]) m_thirds[here] = m_thirds[other] = 1;
        }
    }
    void sweep() {
        for (std::size_t row = 1; row < shoe_rows; ++row) {
            for (std::size_t column = 1; column + 1 < shoe_columns; ++column) {
                const std::size_t here = row * shoe_columns + column, above = here - shoe_columns;
                m_thirds[here] = std::min({m_thirds[here], m_thirds[here - 1] + 3, m_thirds[above] + 3,
                                           m_thirds[above - 1] + 4, m_thirds[above + 1] + 4});
            }
        }
    }

    std::vector<char> m_inside;
    std::vector<int> m_thirds;
};

/// Where a cell lies on the shoe.
struct Place {
    double across;  ///< columns from the middle line, positive to the right
    double along;   ///< rows from the front of the cloth
    double side;    ///< 0 on the middle line, 1 on the outline
    double inward;  ///< cells inside the outline
};

double squared(double x) {
    return x * x;
}

/// Less than 1 inside an ellipse.
double ellipse(const Place& at, double along, double half_width, double half_length) {
    return squared(at.across / half_width) + squared((at.along - along) / half_length);
}

// Lines of the upper, in rows, from the heel to the toe.
constexpr double opening_middle = 262, opening_half_width = 72, opening_half_length = 152;
constexpr double tongue_tip = 352, throat_end = 692;
constexpr double first_eyelet = 446, eyelet_step = 42, eyelets = 6;

double tongue_half_width(double along) {
    return 44 - 16 * std::clamp((along - 400) / 300, 0.0, 1.0);
}
double heel_line(double side) {
    return 98 + 150 * squared(side);
}
double quarter_line(double side) {
    return throat_end + 26 - 190 * squared(side);
}
double cap_line(double side) {
    return 806 + 34 * squared(side);
}

bool in_opening(const Place& at, double margin) {
    // Narrower towards the toe, as a shoe is at the throat.
    const double taper = at.along > opening_middle ? 0.12 * (at.along - opening_middle) : 0;
    return ellipse(at, opening_middle, opening_half_width - taper + margin, opening_half_length + margin) < 1;
}

bool on_tongue(const Place& at, double margin) {
    const double half = tongue_half_width(at.along) + margin, across = std::abs(at.across);
    if (across >= half || at.along < tongue_tip || at.along > throat_end + margin) return false;
    const double from_tip = at.along - tongue_tip, from_end = throat_end + margin - at.along;
    const double round_tip = 26, round_end = half;
    if (from_tip < round_tip && squared(across / half) + squared((round_tip - from_tip) / round_tip) > 1)
        return false;
    return from_end >= round_end || squared(across) + squared(round_end - from_end) < squared(half);
}

bool on_seam(const Place& at) {
    const auto line = [&](double where, double half_width) {
        return std::abs(at.along - where) < half_width;
    };
    return line(heel_line(at.side), 4) || line(cap_line(at.side), 4) || line(cap_line(at.side) + 14, 2.5) ||
           (line(quarter_line(at.side), 4) && !on_tongue(at, 34));
}

/// Rows from the nearest eyelet row, and whether there is one.
double to_eyelet_row(double along) {
    const double step = std::clamp(std::round((along - first_eyelet) / eyelet_step), 0.0, eyelets - 1);
    return along - first_eyelet - step * eyelet_step;
}

/// The lace stay beside the tongue, with the eyelets in it.
Recipe stay(const Place& at, Recipe below) {
    const double from_eyelet =
        std::hypot(to_eyelet_row(at.along), std::abs(at.across) - tongue_half_width(at.along) - 17);
    if (from_eyelet < 5.5) return {below.sole, below.insole, Upper::opening, Join::none};
    if (from_eyelet < 10) return {below.sole, below.insole, Upper::warp_rib, Join::none};
    return {below.sole, below.insole, Upper::herringbone, Join::none};
}

/// The tongue with woven lace loops across it.
Recipe tongue(const Place& at, Recipe below) {
    const bool loop = at.along > first_eyelet - 20 && std::abs(to_eyelet_row(at.along)) < 6;
    return {below.sole, below.insole, loop ? Upper::weft_rib : Upper::weft_face, Join::none};
}

/// Three slanting stripes on each side of the quarters.
bool on_stripe(const Place& at) {
    const double slanted = at.along - 150 * (at.side - 0.75) - 372;
    return slanted > 0 && slanted < 150 && std::fmod(slanted, 50) < 24 && at.inward > 14 && at.side > 0.5;
}

bool on_vent(const Place& at) {
    const double row = std::fmod(at.along, 16) - 8, across = std::fmod(std::abs(at.across) + 8, 16) - 8;
    return at.along > 730 && at.along < 792 && at.side < 0.55 && std::hypot(row, across) < 3.6;
}

/// What the upper is at a place inside the outline, over what lies below.
Recipe upper_at(const Place& at, Recipe below) {
    const auto with = [&](Upper upper, Join join) { return Recipe{below.sole, below.insole, upper, join}; };
    if (on_tongue(at, 0)) return tongue(at, below);
    if (in_opening(at, 0)) return with(Upper::opening, Join::none);
    if (on_tongue(at, 34) && at.along > first_eyelet - 34) return stay(at, below);
    if (on_tongue(at, 38) && at.along > first_eyelet - 38) return with(Upper::weft_rib, Join::sparse);
    if (in_opening(at, 17)) return with(Upper::crepe, Join::none);
    if (on_seam(at)) return with(Upper::weft_rib, Join::sparse);
    if (at.along < heel_line(at.side)) {
        return with(std::abs(at.across) < 20 ? Upper::warp_rib : Upper::warp_face, Join::sparse);
    }
    if (at.along > cap_line(at.side)) return with(Upper::diamond, Join::none);
    if (at.along > quarter_line(at.side))
        return with(on_vent(at) ? Upper::weft_face : Upper::basket, Join::none);
    if (on_stripe(at)) return with(Upper::warp_face, Join::none);
    return with(at.across < 0 ? Upper::twill_left : Upper::twill_right, Join::none);
}

/// Sole and insole under a place inside the outline of the sole.
Recipe lower_at(const Place& at) {
    const double bend = 24 * (at.across / 140);  // the ball runs aslant across the foot
    Recipe recipe;
    if (at.along < 312) {
        recipe.sole = Sole::lugs;
        recipe.insole = ellipse(at, 190, 62, 92) < 1 ? Insole::loft : Insole::firm;
    } else if (at.along < 520 - bend) {
        recipe.sole = Sole::zigzag_right;
        recipe.insole = Insole::firm;
    } else if (at.along < 760 - bend) {
        recipe.sole = Sole::chevron;
        recipe.insole = ellipse(at, 640, 92, 96) < 1 ? Insole::loft : Insole::soft;
    } else {
        recipe.sole = Sole::zigzag_left;
        recipe.insole = Insole::air;
    }
    return recipe;
}

constexpr double rim_width = 9, sole_inset = 34, welt_width = 7, cut_line = 14;

Recipe recipe_at(const Place& at) {
    if (at.inward <= -cut_line) return {Sole::trimmed, Insole::firm, Upper::basket, Join::flat_rib};
    if (at.inward <= rim_width) return {Sole::trimmed, Insole::firm, Upper::basket, Join::flat_twill};
    const bool on_sole = at.inward > sole_inset;
    Recipe recipe = upper_at(at, on_sole ? lower_at(at) : Recipe{});
    if (recipe.upper == Upper::opening) return recipe;
    if (on_sole && at.inward < sole_inset + welt_width) recipe.join = Join::welt;
    if (!on_sole && at.inward < rim_width + 6) recipe.join = Join::dense;
    return recipe;
}

}  // namespace

std::vector<Recipe> shoe_recipes() {
    const std::vector<Span> spans = outline_spans();
    const Distances distances(spans);
    std::vector<Recipe> recipes;
    recipes.reserve(shoe_rows * shoe_columns);
    for (std::size_t row = 0; row < shoe_rows; ++row) {
        const Span& span = spans[row];
        const double middle = (span.left + span.right) / 2,
                     half = std::max(1.0, (span.right - span.left) / 2);
        for (std::size_t column = 0; column < shoe_columns; ++column) {
            const double across = static_cast<double>(column) + 0.5 - middle;
            recipes.push_back(recipe_at({across, static_cast<double>(row) + 0.5, std::abs(across) / half,
                                         distances.at(row, column)}));
        }
    }
    return recipes;
}

}  // namespace weave::sample
