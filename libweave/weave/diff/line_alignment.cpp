#include <weave/diff/line_alignment.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace weave {

namespace {

using Hashes = std::span<const std::uint64_t>;

/// A part of both lists, [before, before_end) and [after, after_end).
struct Box {
    std::size_t before, before_end, after, after_end;
    [[nodiscard]] std::size_t height() const { return before_end - before; }
    [[nodiscard]] std::size_t width() const { return after_end - after; }
};

void add(std::vector<LineMatch>& matches, LineMatch match) {
    if (match.count == 0) return;
    if (!matches.empty()) {
        LineMatch& last = matches.back();
        if (last.before + last.count == match.before && last.after + last.count == match.after) {
            last.count += match.count;
            return;
        }
    }
    matches.push_back(match);
}

void sort_and_join(std::vector<LineMatch>& matches) {
    std::ranges::sort(matches, {}, &LineMatch::before);
    std::vector<LineMatch> joined;
    for (const LineMatch& match : matches) add(joined, match);
    matches = std::move(joined);
}

/// Calls gap(box) for what lies open before, between and after the matches, one side of which may be empty.
template <class Gap>
void each_gap(const LineAlignment& alignment, Gap gap) {
    std::size_t before = 0, after = 0;
    for (const LineMatch& match : alignment.matches) {
        gap(Box{before, match.before, after, match.after});
        before = match.before + match.count;
        after = match.after + match.count;
    }
    gap(Box{before, alignment.before, after, alignment.after});
}

/// Finds the middle of a shortest way of edits through a box: from both corners at once, on each diagonal the
/// furthest point that so many edits reach.
class MiddleSearch {
  public:
    MiddleSearch(Hashes before, Hashes after, std::uint64_t& steps)
        : m_before(before), m_after(after), m_steps(steps) {}

    /// The run of equal lines (it may be empty) where both ways meet, relative to the lists; nothing where
    /// the steps are used up.
    std::optional<LineMatch> find() {
        const auto n = static_cast<std::ptrdiff_t>(m_before.size()),
                   m = static_cast<std::ptrdiff_t>(m_after.size());
        m_room = 2 * std::min(n, m) + 2;
        m_reach[0].assign(static_cast<std::size_t>(m_room), 0);
        m_reach[1].assign(static_cast<std::size_t>(m_room), 0);
        for (std::ptrdiff_t edits = 0; edits <= (n + m + 1) / 2; ++edits) {
            for (const bool backward : {false, true}) {
                if (const auto met = advance(edits, backward)) return met;
            }
            if (m_steps == 0) return std::nullopt;
        }
        return std::nullopt;
    }

  private:
    std::ptrdiff_t& reach(bool backward, std::ptrdiff_t diagonal) {
        const std::ptrdiff_t place = diagonal % m_room;
        return m_reach[backward ? 1 : 0][static_cast<std::size_t>(place < 0 ? place + m_room : place)];
    }
    [[nodiscard]] bool equal(bool backward, std::ptrdiff_t x, std::ptrdiff_t y) const {
        const auto i = static_cast<std::size_t>(x), j = static_cast<std::size_t>(y);
        return backward ? m_before[m_before.size() - 1 - i] == m_after[m_after.size() - 1 - j]
                        : m_before[i] == m_after[j];
    }
    void spend(std::uint64_t steps) { m_steps -= std::min(m_steps, steps); }

    /// One more edit on all diagonals of one side.
    std::optional<LineMatch> advance(std::ptrdiff_t edits, bool backward) {
        const auto n = static_cast<std::ptrdiff_t>(m_before.size()),
                   m = static_cast<std::ptrdiff_t>(m_after.size());
        const std::ptrdiff_t low = -(edits - 2 * std::max<std::ptrdiff_t>(0, edits - m));
        const std::ptrdiff_t high = edits - 2 * std::max<std::ptrdiff_t>(0, edits - n);
        const bool may_meet = ((n + m) % 2 != 0) != backward;
        const std::ptrdiff_t others = edits - (backward ? 0 : 1);
        for (std::ptrdiff_t k = low; k <= high; k += 2) {
            const bool down = k == -edits || (k != edits && reach(backward, k - 1) < reach(backward, k + 1));
            const std::ptrdiff_t x0 = down ? reach(backward, k + 1) : reach(backward, k - 1) + 1;
            std::ptrdiff_t x = x0, y = x0 - k;
            while (x < n && y < m && equal(backward, x, y)) ++x, ++y;
            reach(backward, k) = x;
            spend(static_cast<std::uint64_t>(x - x0) + 1);
            const std::ptrdiff_t facing = n - m - k;
            if (!may_meet || facing < -others || facing > others) continue;
            if (x + reach(!backward, facing) < n) continue;
            const std::ptrdiff_t first_x = backward ? n - x : x0, first_y = backward ? m - y : x0 - k;
            return LineMatch{static_cast<std::size_t>(first_x), static_cast<std::size_t>(first_y),
                             static_cast<std::size_t>(x - x0)};
        }
        return std::nullopt;
    }

    Hashes m_before, m_after;
    std::uint64_t& m_steps;
    std::ptrdiff_t m_room = 0;
    std::vector<std::ptrdiff_t> m_reach[2];
};

/// Takes equal lines off both ends of a box.
void trim(Box& box, Hashes before, Hashes after, std::vector<LineMatch>& matches) {
    std::size_t count = 0;
    const auto shorter = [&] { return std::min(box.height(), box.width()); };
    while (count < shorter() && before[box.before + count] == after[box.after + count]) ++count;
    add(matches, {box.before, box.after, count});
    box.before += count;
    box.after += count;
    count = 0;
    while (count < shorter() && before[box.before_end - 1 - count] == after[box.after_end - 1 - count])
        ++count;
    box.before_end -= count;
    box.after_end -= count;
    add(matches, {box.before_end, box.after_end, count});
}

/// How many of the first lines of a gap's shorter side keep to its front, if all others keep to its back, so
/// that least differs.
std::size_t best_split(const Box& gap, const LineDistance& distance) {
    const std::size_t count = std::min(gap.height(), gap.width());
    std::vector<std::uint64_t> front(count + 1), back(count + 1);
    for (std::size_t k = 0; k < count; ++k) {
        front[k + 1] = front[k] + distance(gap.before + k, gap.after + k);
        back[k + 1] = back[k] + distance(gap.before_end - 1 - k, gap.after_end - 1 - k);
    }
    std::size_t best = count;
    for (std::size_t split = count; split-- > 0;) {
        if (front[split] + back[count - split] < front[best] + back[count - best]) best = split;
    }
    return best;
}

/// Straightens what begins with match k: the last match within sight that the diagonal may reach at less
/// cost.
std::size_t straight_until(const std::vector<LineMatch>& matches, std::size_t k, const LineDistance& distance,
                           std::uint64_t line_length) {
    constexpr std::size_t sight = 32;
    const LineMatch& from = matches[k];
    std::size_t best = k, at = from.before + from.count;
    std::uint64_t straight = 0, detour = 0;
    for (std::size_t j = k + 1; j < matches.size() && j <= k + sight; ++j) {
        const LineMatch &last = matches[j - 1], &next = matches[j];
        const std::size_t removed = next.before - last.before - last.count,
                          inserted = next.after - last.after - last.count;
        detour += line_length *
                  (removed + inserted);  // every line that has a partner there is equal to it, or nearly
        if (next.after + from.before != next.before + from.after) continue;
        for (; at < next.before; ++at) straight += distance(at, at + from.after - from.before);
        if (straight < detour) best = j;
        at = next.before + next.count;
    }
    return best;
}

}  // namespace

std::vector<LineSpan> LineAlignment::removed() const {
    std::vector<LineSpan> spans;
    each_gap(*this, [&](const Box& gap) {
        if (gap.height() > 0) spans.push_back({gap.before, gap.height()});
    });
    return spans;
}

std::vector<LineSpan> LineAlignment::inserted() const {
    std::vector<LineSpan> spans;
    each_gap(*this, [&](const Box& gap) {
        if (gap.width() > 0) spans.push_back({gap.after, gap.width()});
    });
    return spans;
}

std::size_t LineAlignment::matched() const {
    std::size_t sum = 0;
    for (const LineMatch& match : matches) sum += match.count;
    return sum;
}

bool LineAlignment::is_straight() const {
    return before == after && (before == 0 || matches == std::vector<LineMatch>{{0, 0, before}});
}

LineAlignment turned_round(LineAlignment alignment) {
    std::swap(alignment.before, alignment.after);
    for (LineMatch& match : alignment.matches) std::swap(match.before, match.after);
    return alignment;
}

std::vector<MergedSpan> merged(const LineAlignment& alignment) {
    using enum MergedSpan::Kind;
    std::vector<MergedSpan> spans;
    std::size_t next = 0;
    each_gap(alignment, [&](const Box& gap) {
        if (gap.height() > 0) spans.push_back({removed, gap.before, gap.after, gap.height()});
        if (gap.width() > 0) spans.push_back({inserted, gap.before_end, gap.after, gap.width()});
        if (next == alignment.matches.size()) return;
        const LineMatch& match = alignment.matches[next++];
        spans.push_back({matched, match.before, match.after, match.count});
    });
    return spans;
}

LineAlignment matched_from_front(std::size_t before, std::size_t after) {
    LineAlignment alignment{before, after, {}};
    add(alignment.matches, {0, 0, std::min(before, after)});
    return alignment;
}

LineAlignment matched_from_back(std::size_t before, std::size_t after) {
    LineAlignment alignment{before, after, {}};
    const std::size_t count = std::min(before, after);
    add(alignment.matches, {before - count, after - count, count});
    return alignment;
}

LineAlignment match_equal(std::span<const std::uint64_t> before, std::span<const std::uint64_t> after,
                          std::uint64_t most_steps) {
    LineAlignment alignment{before.size(), after.size(), {}};
    std::vector<Box> open{{0, before.size(), 0, after.size()}};
    std::uint64_t steps = most_steps;
    while (!open.empty()) {
        Box box = open.back();
        open.pop_back();
        trim(box, before, after, alignment.matches);
        if (box.height() == 0 || box.width() == 0 || steps == 0) continue;
        MiddleSearch search(before.subspan(box.before, box.height()), after.subspan(box.after, box.width()),
                            steps);
        const std::optional<LineMatch> middle = search.find();
        if (!middle) continue;
        const std::size_t i = box.before + middle->before, j = box.after + middle->after;
        add(alignment.matches, {i, j, middle->count});
        open.push_back({box.before, i, box.after, j});
        open.push_back({i + middle->count, box.before_end, j + middle->count, box.after_end});
    }
    sort_and_join(alignment.matches);
    return alignment;
}

void match_gaps(LineAlignment& alignment, const LineDistance& distance) {
    std::vector<LineMatch> found;
    each_gap(alignment, [&](const Box& gap) {
        const std::size_t count = std::min(gap.height(), gap.width());
        if (count == 0) return;
        const std::size_t split = gap.height() == gap.width() ? count : best_split(gap, distance);
        add(found, {gap.before, gap.after, split});
        add(found, {gap.before_end - (count - split), gap.after_end - (count - split), count - split});
    });
    alignment.matches.insert(alignment.matches.end(), found.begin(), found.end());
    sort_and_join(alignment.matches);
}

void straighten(LineAlignment& alignment, const LineDistance& distance, std::uint64_t line_length) {
    std::vector<LineMatch> straight;
    std::vector<LineMatch> matches{{0, 0, 0}};  // both corners are on the way too
    matches.insert(matches.end(), alignment.matches.begin(), alignment.matches.end());
    matches.push_back({alignment.before, alignment.after, 0});
    for (std::size_t k = 0; k < matches.size();) {
        const std::size_t last = straight_until(matches, k, distance, line_length);
        if (last == k) {
            add(straight, matches[k++]);
            continue;
        }
        const std::size_t end = matches[last].before;
        add(straight, {matches[k].before, matches[k].after, end - matches[k].before});
        k = last;
    }
    alignment.matches = std::move(straight);
}

}  // namespace weave
