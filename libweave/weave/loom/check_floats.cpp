// Rules about the cloth itself: its structure, how far yarns float on a face, and whether each binds.
//
// A yarn floats on the face over consecutive columns (a pick) or rows (an end) in which it is the topmost
// yarn of its stack, on the back where it is the bottommost. With one pick and one end a stack these are the
// runs of the card image: 1s of a pick are its floats on the face, 0s on the back; 0s of an end are its
// floats on the face, 1s on the back.

#include <weave/loom/check_detail.hpp>

#include <algorithm>

namespace weave::check_detail {

namespace {

constexpr std::size_t nowhere = static_cast<std::size_t>(-1);
constexpr std::uint8_t is_over = 1, is_under = 2, is_firm = 4;

/// Ends (of one column, from 0) that a pick spans there: low … high, none where low > high.
struct Reach {
    std::size_t low = 0, high = nowhere;
    [[nodiscard]] bool is_empty() const { return low > high; }
};

/// What one stack says of its yarns.
struct Facts {
    Slot top, bottom;  ///< of the yarns that are in the cloth here
    std::vector<std::uint8_t> wefts,
        warps;  ///< by number: lies over, under a yarn of the other system; not loose here
};

/// `reach` of each weft; empty: all of them span all ends. Loose yarns bind nothing: they go when the cloth
/// is trimmed.
Facts facts_of(const Stack& stack, const std::vector<Reach>& reach = {}) {
    Facts facts;
    facts.wefts.resize(stack.wefts());
    facts.warps.resize(stack.warps());
    const auto slots = stack.slots();
    const auto reach_of = [&](Slot weft) { return reach.empty() ? Reach{} : reach[weft.index()]; };
    const auto is_there = [&](Slot slot) {
        return !slot.is_empty() && !(slot.is_weft() && reach_of(slot).is_empty());
    };
    for (std::size_t a = 0; a < slots.size(); ++a) {
        if (!is_there(slots[a])) continue;
        if (facts.bottom.is_empty()) facts.bottom = slots[a];
        facts.top = slots[a];
        if (slots[a].is_loose()) continue;
        (slots[a].is_weft() ? facts.wefts : facts.warps)[slots[a].index()] |= is_firm;
        if (!slots[a].is_weft()) continue;
        const Reach span = reach_of(slots[a]);
        std::uint8_t& weft = facts.wefts[slots[a].index()];
        for (std::size_t b = 0; b < slots.size(); ++b) {
            if (!slots[b].is_warp() || slots[b].is_loose()) continue;
            if (slots[b].index() < span.low || slots[b].index() > span.high) continue;
            weft |= b < a ? is_over : is_under;
            facts.warps[slots[b].index()] |= b < a ? is_under : is_over;
        }
    }
    return facts;
}

/// The facts of every cell, worked out once for each different stack; anew only where a pick does not span
/// the cell.
class Cloth {
  public:
    explicit Cloth(const Subject& subject) : m_block(subject.block), m_spans(subject.block.picks()) {
        for (const Stack& stack : m_block.stacks()) m_facts.push_back(facts_of(stack));
        for (std::size_t pick = 0; pick < m_spans.size(); ++pick) {
            m_spans[pick] = subject.picks[pick].feeders.empty() ? Reach{1, 0} : Reach{0, m_block.ends() - 1};
        }
        if (subject.turns) take_spans(subject.way);
    }

    [[nodiscard]] const Block& block() const { return m_block; }
    /// A pick that runs anywhere.
    [[nodiscard]] bool is_woven(std::size_t pick) const { return !m_spans[pick].is_empty(); }

    /// Valid until the next call.
    const Facts& at(std::size_t row, std::size_t column) {
        if (column == 0) find_whole_columns(row);
        if (column >= m_first_whole && column < m_end_whole) {
            return m_facts[m_block.cells(row)[column]];
        }
        const std::size_t first = m_block.first_end(column), last = m_block.first_end(column + 1) - 1;
        std::vector<Reach> reach;
        for (std::size_t pick = m_block.first_pick(row); pick < m_block.first_pick(row + 1); ++pick) {
            const Reach span = m_spans[pick];
            const bool meets = !span.is_empty() && span.low <= last && span.high >= first;
            reach.push_back(meets
                                ? Reach{std::max(span.low, first) - first, std::min(span.high, last) - first}
                                : Reach{1, 0});
        }
        m_scratch = facts_of(m_block.stack(row, column), reach);
        return m_scratch;
    }

  private:
    void take_spans(const WeftWay& way) {
        for (const PickSpan& span : way.spans) {
            Reach& reach = m_spans[span.pick];
            // The first of two feeders sets the span, the second can only widen it.
            const bool first = &span == way.spans.data() || (&span)[-1].pick != span.pick;
            reach = first ? Reach{span.first, span.last}
                          : Reach{std::min(reach.low, span.first), std::max(reach.high, span.last)};
        }
    }

    /// The columns of a row that all its picks span whole.
    void find_whole_columns(std::size_t row) {
        Reach common{0, m_block.ends() - 1};
        for (std::size_t pick = m_block.first_pick(row); pick < m_block.first_pick(row + 1); ++pick) {
            common.low = std::max(common.low, m_spans[pick].low);
            common.high = std::min(common.high, m_spans[pick].high);
        }
        m_first_whole = m_end_whole = 0;
        if (common.is_empty()) return;
        m_first_whole = m_block.column_of_end(common.low);
        if (m_block.first_end(m_first_whole) < common.low) ++m_first_whole;
        m_end_whole = m_block.column_of_end(common.high);
        if (m_block.first_end(m_end_whole + 1) == common.high + 1) ++m_end_whole;
    }

    const Block& m_block;
    std::vector<Facts> m_facts;
    std::vector<Reach> m_spans;
    std::size_t m_first_whole = 0, m_end_whole = 0;
    Facts m_scratch;
};

/// For each pick and end: over, under, and not loose, all together.
struct Binding {
    std::vector<std::uint8_t> picks, ends;
};

Binding binding_of(Cloth& cloth) {
    const Block& block = cloth.block();
    Binding binding{std::vector<std::uint8_t>(block.picks()), std::vector<std::uint8_t>(block.ends())};
    for (std::size_t row = 0; row < block.rows(); ++row) {
        for (std::size_t column = 0; column < block.columns(); ++column) {
            const Facts& facts = cloth.at(row, column);
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

/// Counts how long the same yarn stays on a face along one line of cells. The line may close at the repeat.
class Runs {
  public:
    /// The yarn on the face in the next cell, or nowhere. `found(yarn, first, length)` is told of each run
    /// that ends.
    template <class Found>
    void step(std::size_t position, std::size_t yarn, Found found) {
        if (position == 0) {
            m_opening = 0;
            m_opening_yarn = m_yarn = yarn;
            m_first = 0;
            m_opening_done = false;
            return;
        }
        if (yarn == m_yarn) return;
        leave(position, found);
        m_yarn = yarn;
        m_first = position;
    }

    /// After the last of `length` cells. A run over the whole line is no float: nothing crosses it.
    template <class Found>
    void finish(std::size_t length, bool closes, Found found) {
        if (!m_opening_done) return;
        const bool joins = closes && m_yarn == m_opening_yarn;
        if (m_yarn != nowhere) found(m_yarn, m_first, length - m_first + (joins ? m_opening : 0));
        if (!joins && m_opening_yarn != nowhere) found(m_opening_yarn, 0, m_opening);
    }

  private:
    template <class Found>
    void leave(std::size_t position, Found found) {
        if (!m_opening_done) {
            m_opening_done = true;
            m_opening = position;
        } else if (m_yarn != nowhere) {
            found(m_yarn, m_first, position - m_first);
        }
    }

    std::size_t m_opening = 0, m_opening_yarn = nowhere, m_yarn = nowhere, m_first = 0;
    bool m_opening_done = false;
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
        const bool counts = !slot.is_empty() && !slot.is_loose();
        const Block& block = m_subject.block;
        const std::size_t pick = counts && slot.is_weft() ? block.first_pick(row) + slot.index() : nowhere;
        const std::size_t end = counts && slot.is_warp() ? block.first_end(column) + slot.index() : nowhere;
        m_row.step(column, pick, [&](auto... run) { weft_float(run...); });
        m_columns[column].step(row, end, [&](auto... run) { warp_float(run...); });
    }

    void end_row() {
        const bool closes = m_subject.design.scene.weft_mode == WeftMode::periodic;
        m_row.finish(m_subject.block.columns(), closes, [&](auto... run) { weft_float(run...); });
    }

    void end_cloth() {
        for (Runs& column : m_columns) {
            column.finish(m_subject.block.rows(), true, [&](auto... run) { warp_float(run...); });
        }
    }

  private:
    void weft_float(std::size_t pick, std::size_t first, std::size_t length) {
        if (length <= m_limit || is_unbound(m_binding.picks[pick])) return;
        const Block& block = m_subject.block;
        const std::size_t last = (first + length - 1) % block.columns();
        const bool single = block.columns() == block.ends();
        m_rule.find({pick, block.first_end(first)},
                    sentence("pick " + person(pick), counted(length, single ? "end" : "column of ends"),
                             "end", block.first_end(first), block.first_end(last + 1) - 1, last < first));
    }

    void warp_float(std::size_t end, std::size_t first, std::size_t length) {
        if (length <= m_limit || is_unbound(m_binding.ends[end])) return;
        const Block& block = m_subject.block;
        const std::size_t last = (first + length - 1) % block.rows();
        const bool single = block.rows() == block.picks();
        m_rule.find({block.first_pick(first), end},
                    sentence("end " + person(end), counted(length, single ? "pick" : "row of picks"), "pick",
                             block.first_pick(first), block.first_pick(last + 1) - 1, last < first));
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

void report_floats(const Subject& subject, Cloth& cloth, const Binding& binding, CheckReport& report) {
    RuleReport face_rule(report, subject.profile, "float.face"),
        back_rule(report, subject.profile, "float.back");
    const LoomLimits& limits = subject.profile.limits;
    const bool no_face = limits.float_face == 0, no_back = limits.float_back == 0;
    if (no_face) face_rule.not_evaluated("the profile sets no limit for floats on the face");
    if (no_back) back_rule.not_evaluated("the profile sets no limit for floats on the back");
    Floats face(subject, binding, true, no_face ? nowhere : limits.float_face, face_rule);
    Floats back(subject, binding, false, no_back ? nowhere : limits.float_back, back_rule);
    for (std::size_t row = 0; row < subject.block.rows(); ++row) {
        for (std::size_t column = 0; column < subject.block.columns(); ++column) {
            const Facts& facts = cloth.at(row, column);
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

void check_structure(const Subject& subject, CheckReport& report) {
    {
        RuleReport rule(report, subject.profile, "block.constraints");
        const Block& block = subject.block;
        for (std::size_t row = 0; row < block.rows(); ++row) {
            for (std::size_t column = 0; column < block.columns(); ++column) {
                const Stack& stack = block.stack(row, column);
                if (stack.wefts() == block.t()[row] && stack.warps() == block.p()[column]) continue;
                rule.find({block.first_pick(row), block.first_end(column)},
                          "the stack in row " + person(row) + ", column " + person(column) + " holds " +
                              counted(stack.wefts(), "pick") + " and " + counted(stack.warps(), "end") +
                              " instead of " + std::to_string(block.t()[row]) + " and " +
                              std::to_string(block.p()[column]));
            }
        }
        for (const Stack& stack : block.stacks()) {
            if (const Status status = stack.check(); !status) rule.find({}, status.error().text());
        }
    }
    RuleReport rule(report, subject.profile, "flips.apply");
    for (const LostFlip& lost : subject.cloth.lost_flips) {
        // Numbers of a flip count in its own block; only in the root are they those of the cloth.
        const bool in_cloth = lost.block == subject.design.root;
        rule.find(in_cloth ? Place{lost.flip.pick, lost.flip.end} : Place{},
                  "the flip of pick " + person(lost.flip.pick) + " and end " + person(lost.flip.end) +
                      " in block '" + lost.block + "' no longer applies: " + lost.reason);
    }
}

void check_floats(const Subject& subject, CheckReport& report) {
    Cloth cloth(subject);
    const Binding binding = binding_of(cloth);
    report_binding(subject, cloth, binding, report);
    report_floats(subject, cloth, binding, report);
}

}  // namespace weave::check_detail
