#include <weave/diff/card_diff.hpp>

#include <weave/block/card_bits.hpp>

#include <algorithm>
#include <bit>
#include <unordered_map>
#include <utility>

namespace weave {

namespace {

constexpr std::size_t word = 64;

/// Where and how a picture of changes goes on from word to word of one pick, one kind of change at a time.
class RunCounter {
  public:
    RunCounter(CardDiff& diff, bool lifted) : m_diff(diff), m_lifted(lifted) {}

    /// The changes of up to 64 crossings, the first in the most significant bit. `fresh`: no run goes on
    /// here.
    void add(std::uint64_t changes, const ChangedRun& at, std::size_t count, bool fresh) {
        if (fresh) m_open = false;
        (m_lifted ? m_diff.lifted : m_diff.lowered) += static_cast<std::uint64_t>(std::popcount(changes));
        const std::uint64_t starts = changes & ~(changes >> 1 | (m_open ? std::uint64_t{1} << 63 : 0));
        m_diff.runs_in_all += static_cast<std::uint64_t>(std::popcount(starts));
        if (changes != 0) list(changes, at, count);
        m_open = (changes >> (word - count) & 1) != 0;
        if (!m_open) m_last = nothing;
    }

  private:
    static constexpr std::size_t nothing = static_cast<std::size_t>(-1);

    void list(std::uint64_t changes, const ChangedRun& at, std::size_t count) {
        for (std::size_t k = 0; k < count;) {
            k += static_cast<std::size_t>(std::countl_zero(changes << k));
            if (k >= count) break;
            const auto length =
                std::min<std::size_t>(static_cast<std::size_t>(std::countl_one(changes << k)), count - k);
            if (k == 0 && m_open) {
                if (m_last != nothing) m_diff.runs[m_last].count += length;
            } else if (m_diff.runs.size() < CardDiff::most_runs) {
                m_last = m_diff.runs.size();
                m_diff.runs.push_back(
                    {at.pick_before, at.pick_after, at.end_before + k, at.end_after + k, length, m_lifted});
            } else {
                m_last = nothing;
            }
            k += length;
        }
    }

    CardDiff& m_diff;
    bool m_lifted, m_open = false;
    std::size_t m_last = nothing;  ///< the run that is open, where it is listed
};

void widen(std::optional<ChangedBox>& box, std::size_t pick, std::size_t first_end, std::size_t last_end) {
    if (!box) box = {pick, pick, first_end, last_end};
    box->first_pick = std::min(box->first_pick, pick);
    box->last_pick = std::max(box->last_pick, pick);
    box->first_end = std::min(box->first_end, first_end);
    box->last_end = std::max(box->last_end, last_end);
}

/// Goes through all crossings of matched picks and ends.
class Comparison {
  public:
    Comparison(const CardImage& before, const CardImage& after, CardDiff& diff)
        : m_before(before), m_after(after), m_diff(diff), m_changed_ends(after.row_bytes() * 8 / word + 1) {}

    void run() {
        for (const LineMatch& picks : m_diff.alignment.picks.matches) {
            for (std::size_t k = 0; k < picks.count; ++k) compare(picks.before + k, picks.after + k);
        }
        for (const std::uint64_t bits : m_changed_ends)
            m_diff.ends += static_cast<std::size_t>(std::popcount(bits));
        std::ranges::stable_sort(
            m_diff.runs, {}, [](const ChangedRun& run) { return std::pair(run.pick_after, run.end_after); });
    }

  private:
    void compare(std::size_t pick_before, std::size_t pick_after) {
        RunCounter lifted(m_diff, true), lowered(m_diff, false);
        const std::uint64_t so_far = m_diff.changed();
        for (const LineMatch& ends : m_diff.alignment.ends.matches) {
            m_diff.compared += ends.count;
            for (std::size_t k = 0; k < ends.count; k += word) {
                const std::size_t count = std::min(word, ends.count - k);
                const ChangedRun at{pick_before, pick_after, ends.before + k, ends.after + k, 0, false};
                const std::uint64_t old = bits_at(m_before.row(pick_before), at.end_before, count);
                const std::uint64_t now = bits_at(m_after.row(pick_after), at.end_after, count);
                lifted.add(old & ~now, at, count, k == 0);
                lowered.add(now & ~old, at, count, k == 0);
                if (old != now) note_place(old ^ now, at);
            }
        }
        if (m_diff.changed() != so_far) ++m_diff.picks;
    }

    void note_place(std::uint64_t changes, const ChangedRun& at) {
        const auto first = static_cast<std::size_t>(std::countl_zero(changes));
        const auto last = word - 1 - static_cast<std::size_t>(std::countr_zero(changes));
        widen(m_diff.before, at.pick_before, at.end_before + first, at.end_before + last);
        widen(m_diff.after, at.pick_after, at.end_after + first, at.end_after + last);
        const std::size_t place = at.end_after / word, shift = at.end_after % word;
        m_changed_ends[place] |= changes >> shift;
        if (shift != 0 && (changes << (word - shift)) != 0)
            m_changed_ends[place + 1] |= changes << (word - shift);
    }

    const CardImage &m_before, &m_after;
    CardDiff& m_diff;
    std::vector<std::uint64_t> m_changed_ends;
};

/// The one line of this content among those that differ; none where there are several.
class LinesByContent {
  public:
    void add(std::uint64_t hash, std::size_t line) {
        const auto [found, is_new] = m_lines.try_emplace(hash, line);
        if (!is_new) found->second = several;
    }
    [[nodiscard]] std::optional<std::size_t> only(std::uint64_t hash) const {
        const auto found = m_lines.find(hash);
        if (found == m_lines.end() || found->second == several) return std::nullopt;
        return found->second;
    }

  private:
    static constexpr std::size_t several = static_cast<std::size_t>(-1);
    std::unordered_map<std::uint64_t, std::size_t> m_lines;
};

/// Lines that differ where they lie, and equal one elsewhere.
std::vector<MovedLine> moved_lines(const CardImage& before, const CardImage& after,
                                   const LineAlignment& lines, const LineAlignment& across) {
    const std::vector<std::uint64_t> old = line_hashes(before, across, true),
                                     now = line_hashes(after, across, false);
    LinesByContent old_lines, now_lines;
    std::vector<std::size_t> differing;
    for (const MergedSpan& span : merged(lines)) {
        for (std::size_t k = 0; k < span.count; ++k) {
            const bool matched = span.kind == MergedSpan::Kind::matched;
            if (matched && old[span.before + k] == now[span.after + k]) continue;
            if (span.kind != MergedSpan::Kind::inserted) old_lines.add(old[span.before + k], span.before + k);
            if (span.kind == MergedSpan::Kind::removed) continue;
            now_lines.add(now[span.after + k], span.after + k);
            differing.push_back(span.after + k);
        }
    }
    std::vector<MovedLine> moved;
    for (const std::size_t line : differing) {
        const std::optional<std::size_t> from = old_lines.only(now[line]);
        if (!from || !now_lines.only(now[line])) continue;
        if (changed_in_line(before, after, *from, line, across) == 0) moved.push_back({*from, line});
    }
    return moved;
}

}  // namespace

CardDiff diff_cards(const CardImage& before, const CardImage& after) {
    CardDiff diff;
    diff.alignment = align_cards(before, after);
    Comparison(before, after, diff).run();
    if (diff.is_same()) return diff;
    const auto& [picks, ends] = diff.alignment;
    diff.moved_picks = moved_lines(before, after, picks, ends);
    diff.moved_ends = moved_lines(before.transposed(), after.transposed(), ends, picks);
    return diff;
}

}  // namespace weave
