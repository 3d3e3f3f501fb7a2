// Rules about the cloth itself: how far yarns float on a face, and whether each binds.
//
// A yarn floats on the face over consecutive columns (a pick) or rows (an end) in which it is the topmost
// yarn of its stack, on the back where it is the bottommost. The length of a float is the number of stacks
// in which it passes a yarn of the other system: of picks or ends that lie on each other only one is seen on
// a face, so they count as one. With one pick and one end a stack these are the runs of the card image: 1s of
// a pick are its floats on the face, 0s on the back; 0s of an end are its floats on the face, 1s on the back.
//
// Loose yarns are looked through, for they go when the cloth is trimmed. Where a yarn passes nothing that is
// there (a pick without weft, loose ends alone) its float is neither longer for it nor broken.

#include <weave/loom/check_detail.hpp>

#include <algorithm>
#include <span>

namespace weave::check_detail {

namespace {

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);
/// On a line of one system a yarn of the other lies on the face: no yarn has this number.
constexpr std::size_t other_system = nowhere - 1;
constexpr std::uint8_t is_over = 1, is_under = 2, is_firm = 4;

/// Ends (of one column, from 0) that a pick spans there: low … high, none where low > high.
struct Reach {
    std::size_t low = 0, high = nowhere;
    [[nodiscard]] bool is_empty() const { return low > high; }
};

/// What one stack says of its yarns.
struct Facts {
    Slot top, bottom;  ///< of the firm yarns that are in the cloth here, if they pass a firm yarn
    /// By number: lies over, under a firm yarn of the other system; is firm here.
    std::vector<std::uint8_t> wefts, warps;
};

/// The lowest and the highest place of some yarns in a stack.
struct Places {
    std::size_t lowest = nowhere, highest = 0;
    void add(std::size_t place) {
        lowest = std::min(lowest, place);
        highest = std::max(highest, place);
    }
    /// How a yarn at a place lies to them.
    [[nodiscard]] std::uint8_t seen_from(std::size_t place) const {
        if (lowest == nowhere) return 0;
        return static_cast<std::uint8_t>((lowest < place ? is_over : 0) | (highest > place ? is_under : 0));
    }
};

/// Collects the facts of one stack in time linear in its yarns and in the ends of picks that span only part
/// of it.
class FactFinder {
  public:
    /// `reach` of each weft; empty: all of them span all ends.
    FactFinder(const Stack& stack, const std::vector<Reach>& reach)
        : m_slots(stack.slots()), m_reach(reach), m_place_of_warp(stack.warps(), nowhere) {
        m_facts.wefts.resize(stack.wefts());
        m_facts.warps.resize(stack.warps());
        for (std::size_t place = 0; place < m_slots.size(); ++place) {
            if (!m_slots[place].is_warp() || m_slots[place].is_loose()) continue;
            m_place_of_warp[m_slots[place].index()] = place;
            m_facts.warps[m_slots[place].index()] = is_firm;
            m_all_warps.add(place);
        }
    }

    Facts facts() && {
        Places whole_wefts;
        for (std::size_t place = 0; place < m_slots.size(); ++place) {
            if (!is_firm_weft(place)) continue;
            if (is_whole(m_slots[place])) {
                m_facts.wefts[m_slots[place].index()] = is_firm | m_all_warps.seen_from(place);
                whole_wefts.add(place);
            } else {
                cross_in_reach(place);
            }
        }
        for (std::size_t warp = 0; warp < m_facts.warps.size(); ++warp) {
            const std::size_t place = m_place_of_warp[warp];
            if (place != nowhere) m_facts.warps[warp] |= whole_wefts.seen_from(place);
        }
        find_faces();
        return std::move(m_facts);
    }

  private:
    [[nodiscard]] bool is_firm_weft(std::size_t place) const {
        const Slot slot = m_slots[place];
        if (!slot.is_weft() || slot.is_loose()) return false;
        return m_reach.empty() || !m_reach[slot.index()].is_empty();
    }

    [[nodiscard]] bool is_whole(Slot weft) const {
        if (m_reach.empty()) return true;
        const Reach reach = m_reach[weft.index()];
        return reach.low == 0 && reach.high + 1 >= m_facts.warps.size();
    }

    void cross_in_reach(std::size_t place) {
        const std::size_t weft = m_slots[place].index();
        std::uint8_t& flags = m_facts.wefts[weft];
        flags = is_firm;
        for (std::size_t warp = m_reach[weft].low; warp <= m_reach[weft].high; ++warp) {
            const std::size_t other = m_place_of_warp[warp];
            if (other == nowhere) continue;
            flags |= other < place ? is_over : is_under;
            m_facts.warps[warp] |= other < place ? is_under : is_over;
        }
    }

    [[nodiscard]] bool is_firm_yarn(std::size_t place) const {
        const Slot slot = m_slots[place];
        return slot.is_weft() ? is_firm_weft(place) : slot.is_warp() && !slot.is_loose();
    }

    [[nodiscard]] bool passes(Slot slot, std::uint8_t side) const {
        return ((slot.is_weft() ? m_facts.wefts : m_facts.warps)[slot.index()] & side) != 0;
    }

    void find_faces() {
        Places firm;
        for (std::size_t place = 0; place < m_slots.size(); ++place) {
            if (is_firm_yarn(place)) firm.add(place);
        }
        if (firm.lowest == nowhere) return;
        if (passes(m_slots[firm.highest], is_over)) m_facts.top = m_slots[firm.highest];
        if (passes(m_slots[firm.lowest], is_under)) m_facts.bottom = m_slots[firm.lowest];
    }

    std::span<const Slot> m_slots;
    const std::vector<Reach>& m_reach;
    std::vector<std::size_t> m_place_of_warp;
    Places m_all_warps;
    Facts m_facts;
};

Facts facts_of(const Stack& stack, const std::vector<Reach>& reach = {}) {
    return FactFinder(stack, reach).facts();
}

/// The facts of every cell, worked out once for each different stack; anew only where a pick does not span
/// the cell.
class Cloth {
  public:
    explicit Cloth(const Subject& subject) : m_block(subject.block), m_spans(spans_of(subject)) {
        for (const Stack& stack : m_block.stacks()) m_facts.push_back(facts_of(stack));
    }

    [[nodiscard]] const Block& block() const { return m_block; }
    /// A pick that runs anywhere.
    [[nodiscard]] bool is_woven(std::size_t pick) const { return !m_spans[pick].is_empty(); }

    /// One row of cells after the other.
    class Row {
      public:
        Row(const Cloth& cloth, std::size_t row) : m_cloth(cloth), m_row(row) { find_whole_columns(); }

        /// Valid until the next call.
        const Facts& at(std::size_t column) {
            const Block& block = m_cloth.m_block;
            if (column >= m_first_whole && column < m_end_whole)
                return m_cloth.m_facts[block.cells(m_row)[column]];
            m_reach.clear();
            for (std::size_t pick = block.first_pick(m_row); pick < block.first_pick(m_row + 1); ++pick) {
                m_reach.push_back(m_cloth.reach(pick, column));
            }
            m_scratch = facts_of(block.stack(m_row, column), m_reach);
            return m_scratch;
        }

      private:
        /// The columns that all picks of the row span whole.
        void find_whole_columns() {
            const Block& block = m_cloth.m_block;
            Reach common{0, block.ends() - 1};
            for (std::size_t pick = block.first_pick(m_row); pick < block.first_pick(m_row + 1); ++pick) {
                common.low = std::max(common.low, m_cloth.m_spans[pick].low);
                common.high = std::min(common.high, m_cloth.m_spans[pick].high);
            }
            if (common.is_empty()) return;
            m_first_whole = block.column_of_end(common.low);
            if (block.first_end(m_first_whole) < common.low) ++m_first_whole;
            m_end_whole = block.column_of_end(common.high);
            if (block.first_end(m_end_whole + 1) == common.high + 1) ++m_end_whole;
        }

        const Cloth& m_cloth;
        std::size_t m_row, m_first_whole = 0, m_end_whole = 0;
        std::vector<Reach> m_reach;
        Facts m_scratch;
    };

    [[nodiscard]] Row row(std::size_t row) const { return {*this, row}; }

  private:
    /// From where to where each pick runs; of two feeders in a pick the outermost ends count.
    static std::vector<Reach> spans_of(const Subject& subject) {
        const Reach everywhere{0, subject.block.ends() - 1}, absent{1, 0};
        std::vector<Reach> spans(subject.picks.size(), absent);
        for (std::size_t pick = 0; pick < spans.size() && !subject.turns; ++pick) {
            if (!subject.picks[pick].feeders.empty()) spans[pick] = everywhere;
        }
        for (const PickSpan& span : subject.way.spans) {
            Reach& reach = spans[span.pick];
            reach = reach.is_empty()
                        ? Reach{span.first, span.last}
                        : Reach{std::min(reach.low, span.first), std::max(reach.high, span.last)};
        }
        return spans;
    }

    /// The ends of a column that a pick spans.
    [[nodiscard]] Reach reach(std::size_t pick, std::size_t column) const {
        const std::size_t first = m_block.first_end(column), last = m_block.first_end(column + 1) - 1;
        const Reach span = m_spans[pick];
        if (span.is_empty() || span.low > last || span.high < first) return {1, 0};
        return {std::max(span.low, first) - first, std::min(span.high, last) - first};
    }

    const Block& m_block;
    std::vector<Facts> m_facts;
    std::vector<Reach> m_spans;
};

/// For each pick and end: over, under, and not loose, all together.
struct Binding {
    std::vector<std::uint8_t> picks, ends;
};

Binding binding_of(const Cloth& cloth) {
    const Block& block = cloth.block();
    Binding binding{std::vector<std::uint8_t>(block.picks()), std::vector<std::uint8_t>(block.ends())};
    for (std::size_t row = 0; row < block.rows(); ++row) {
        Cloth::Row cells = cloth.row(row);
        for (std::size_t column = 0; column < block.columns(); ++column) {
            const Facts& facts = cells.at(column);
            for (std::size_t k = 0; k < facts.wefts.size(); ++k)
                binding.picks[block.first_pick(row) + k] |= facts.wefts[k];
            for (std::size_t k = 0; k < facts.warps.size(); ++k)
                binding.ends[block.first_end(column) + k] |= facts.warps[k];
        }
    }
    return binding;
}

bool is_unbound(std::uint8_t flags) {
    return (flags & is_firm) != 0 && (flags & (is_over | is_under)) != (is_over | is_under);
}

std::string unbound(const std::string& yarn, std::uint8_t flags, const char* others, const char* other) {
    if ((flags & (is_over | is_under)) == 0)
        return yarn + " crosses no " + other + " that stays in the cloth, so nothing holds it";
    return yarn + " lies " + ((flags & is_over) != 0 ? "over" : "under") + " all " + others +
           " of the repeat and does not bind; if it is a placeholder or trimmed, mark it as loose";
}

void report_binding(const Subject& subject, const Cloth& cloth, const Binding& binding, CheckReport& report) {
    {
        RuleReport rule(report, subject.profile, "bind.pick");
        for (std::size_t pick = 0; pick < binding.picks.size(); ++pick) {
            if (!cloth.is_woven(pick) || !is_unbound(binding.picks[pick])) continue;
            rule.find(at_pick(pick), unbound("pick " + person(pick), binding.picks[pick], "ends", "end"));
        }
    }
    RuleReport rule(report, subject.profile, "bind.end");
    for (std::size_t end = 0; end < binding.ends.size(); ++end) {
        if (!is_unbound(binding.ends[end])) continue;
        rule.find(at_end(end), unbound("end " + person(end), binding.ends[end], "picks", "pick"));
    }
}

/// A yarn on a face from one position of a line to another, over `length` stacks.
struct Run {
    std::size_t yarn = nowhere, first = 0, last = 0, length = 0;
};

/// Counts how long the same yarn stays on a face along one line of cells. The line may close at the repeat.
class Runs {
  public:
    /// The yarn on the face in the next cell where one passes anything. `found(run)` is told of each run that
    /// ends.
    template <class Found>
    void step(std::size_t position, std::size_t yarn, Found found) {
        if (yarn != m_run.yarn) {
            leave(found);
            m_run = {yarn, position, position, 0};
        }
        m_run.last = position;
        ++m_run.length;
    }

    /// After the last cell. A run over the whole line is no float: nothing crosses it.
    template <class Found>
    void finish(bool closes, Found found) {
        if (m_opening.yarn != nowhere) {
            if (closes && m_run.yarn == m_opening.yarn) {
                found(Run{m_run.yarn, m_run.first, m_opening.last, m_run.length + m_opening.length});
            } else {
                found(m_run);
                found(m_opening);
            }
        }
        m_run = m_opening = {};
    }

  private:
    template <class Found>
    void leave(Found found) {
        if (m_run.yarn == nowhere) return;
        if (m_opening.yarn == nowhere)
            m_opening = m_run;
        else
            found(m_run);
    }

    Run m_opening, m_run;  ///< the first of the line, and the one that goes on
};

/// Floats on one face.
class Floats {
  public:
    Floats(const Subject& subject, const Binding& binding, bool face, std::size_t limit, RuleReport& rule)
        : m_subject(subject),
          m_binding(binding),
          m_face(face),
          m_limit(limit),
          m_rule(rule),
          m_columns(subject.block.columns()) {}

    void look(std::size_t row, std::size_t column, const Facts& facts) {
        const Slot slot = m_face ? facts.top : facts.bottom;
        if (slot.is_empty()) return;
        const Block& block = m_subject.block;
        const std::size_t pick = slot.is_weft() ? block.first_pick(row) + slot.index() : other_system;
        const std::size_t end = slot.is_warp() ? block.first_end(column) + slot.index() : other_system;
        m_row.step(column, pick, [&](const Run& run) { weft_float(run); });
        m_columns[column].step(row, end, [&](const Run& run) { warp_float(run); });
    }

    void end_row() {
        const bool closes = m_subject.design.scene.weft_mode == WeftMode::periodic;
        m_row.finish(closes, [&](const Run& run) { weft_float(run); });
    }

    void end_cloth() {
        for (Runs& column : m_columns) {
            column.finish(true, [&](const Run& run) { warp_float(run); });
        }
    }

  private:
    void weft_float(const Run& run) {
        if (run.yarn == other_system || run.length <= m_limit || is_unbound(m_binding.picks[run.yarn]))
            return;
        const Block& block = m_subject.block;
        const bool single = block.columns() == block.ends();
        const std::string passed =
            single ? counted(run.length, "end") : counted(run.length, "column") + " of ends";
        m_rule.find({run.yarn, block.first_end(run.first)},
                    sentence("pick " + person(run.yarn), passed, "end", block.first_end(run.first),
                             block.first_end(run.last + 1) - 1, run.last < run.first));
    }

    void warp_float(const Run& run) {
        if (run.yarn == other_system || run.length <= m_limit || is_unbound(m_binding.ends[run.yarn])) return;
        const Block& block = m_subject.block;
        const bool single = block.rows() == block.picks();
        const std::string passed =
            single ? counted(run.length, "pick") : counted(run.length, "row") + " of picks";
        m_rule.find({block.first_pick(run.first), run.yarn},
                    sentence("end " + person(run.yarn), passed, "pick", block.first_pick(run.first),
                             block.first_pick(run.last + 1) - 1, run.last < run.first));
    }

    [[nodiscard]] std::string sentence(const std::string& yarn, const std::string& passed,
                                       const std::string& other, std::size_t first, std::size_t last,
                                       bool through_repeat) const {
        return yarn + " floats on the " + (m_face ? "face" : "back") + " over " + passed + ", from " + other +
               " " + person(first) + (through_repeat ? " through the repeat to " : " to ") + person(last) +
               "; this loom's limit is " + std::to_string(m_limit);
    }

    const Subject& m_subject;
    const Binding& m_binding;
    bool m_face;
    std::size_t m_limit;
    RuleReport& m_rule;
    Runs m_row;
    std::vector<Runs> m_columns;
};

void report_floats(const Subject& subject, const Cloth& cloth, const Binding& binding, CheckReport& report) {
    RuleReport face_rule(report, subject.profile, "float.face"),
        back_rule(report, subject.profile, "float.back");
    const LoomLimits& limits = subject.profile.limits;
    const bool no_face = limits.float_face == 0, no_back = limits.float_back == 0;
    if (no_face) face_rule.not_evaluated("the profile sets no limit for floats on the face");
    if (no_back) back_rule.not_evaluated("the profile sets no limit for floats on the back");
    Floats face(subject, binding, true, no_face ? nowhere : limits.float_face, face_rule);
    Floats back(subject, binding, false, no_back ? nowhere : limits.float_back, back_rule);
    for (std::size_t row = 0; row < subject.block.rows(); ++row) {
        Cloth::Row cells = cloth.row(row);
        for (std::size_t column = 0; column < subject.block.columns(); ++column) {
            const Facts& facts = cells.at(column);
            face.look(row, column, facts);
            back.look(row, column, facts);
        }
        face.end_row();
        back.end_row();
    }
    face.end_cloth();
    back.end_cloth();
}

}  // namespace

void check_floats(const Subject& subject, CheckReport& report) {
    const Cloth cloth(subject);
    const Binding binding = binding_of(cloth);
    report_binding(subject, cloth, binding, report);
    report_floats(subject, cloth, binding, report);
}

}  // namespace weave::check_detail
