#include <weave/loom/check.hpp>

#include <weave/loom/check_detail.hpp>

#include <algorithm>
#include <cstdio>

namespace weave {

namespace check_detail {

namespace {

Severity severity_of(const LoomProfile& profile, const std::string& id) {
    const auto own = profile.severities.find(id);
    if (own != profile.severities.end()) return own->second;
    const auto rule = std::find_if(rules().begin(), rules().end(), [&](const Rule& r) { return r.id == id; });
    return rule == rules().end() ? Severity::error : rule->severity;
}

}  // namespace

RuleReport::RuleReport(CheckReport& report, const LoomProfile& profile, std::string_view id)
    : m_report(report), m_id(id), m_severity(severity_of(profile, m_id)) {
    if (!wanted()) not_evaluated("switched off by the loom profile");
}

RuleReport::~RuleReport() {
    if (m_found > most_findings_per_rule) {
        const std::size_t more = m_found - most_findings_per_rule;
        m_report.findings.push_back(
            {m_id, m_severity, {}, {}, "the same in " + counted(more, "more place") + ", not listed"});
    }
    if (m_evaluated && m_found == 0) m_report.passed.push_back(m_id);
}

void RuleReport::find(Place place, const std::string& message) {
    if (!wanted()) return;
    ++m_report.counts[static_cast<std::size_t>(m_severity)];
    if (++m_found <= most_findings_per_rule) {
        m_report.findings.push_back({m_id, m_severity, place.pick, place.end, message});
    }
}

void RuleReport::tell(Place place, const std::string& message) {
    if (!wanted()) return;
    ++m_report.counts[static_cast<std::size_t>(Severity::info)];
    m_report.findings.push_back({m_id, Severity::info, place.pick, place.end, message});
}

void RuleReport::not_evaluated(std::string reason) {
    if (!m_evaluated) return;
    m_evaluated = false;
    m_report.not_evaluated.push_back({m_id, std::move(reason)});
}

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f %%", share * 100);
    return text;
}

std::string decimal(double value, int digits) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

}  // namespace check_detail

namespace {

using check_detail::Subject;

bool has_loose_ends(const Block& block) {
    return std::any_of(block.stacks().begin(), block.stacks().end(), [](const Stack& stack) {
        return std::any_of(stack.slots().begin(), stack.slots().end(),
                           [](Slot slot) { return slot.is_warp() && slot.is_loose(); });
    });
}

/// Worst first, then by rule, pick and end; a finding without a place stands after those with one, as it
/// counts the rest.
bool comes_before(const Finding& a, const Finding& b) {
    static constexpr auto none = static_cast<std::size_t>(-1);
    const auto key = [](const Finding& finding) {
        return std::tuple(-static_cast<int>(finding.severity), std::string_view(finding.rule),
                          finding.pick.value_or(none), finding.end.value_or(none));
    };
    return key(a) < key(b);
}

}  // namespace

CheckReport check_for_loom(const Design& design, const Evaluation& cloth, const LoomProfile& profile,
                           const std::optional<RelaxedCloth>& relaxed,
                           const std::optional<ReadBack>& read_back) {
    const Block& block = *cloth.block;
    Subject subject{design, cloth, profile, relaxed, read_back, block, block.card_image(), pick_table(design, block),
                    {},     {},    false};
    subject.turns = profile.insertion == Insertion::shuttle && design.scene.weft_mode == WeftMode::wraparound;
    if (subject.turns) {
        if (has_loose_ends(block)) subject.loose = loose_ends(block);
        subject.way = weft_way(subject.card, subject.picks, subject.loose ? &*subject.loose : nullptr);
    }

    CheckReport report;
    check_detail::check_structure(subject, report);
    check_detail::check_floats(subject, report);
    check_detail::check_hooks(subject, report);
    check_detail::check_selvedge(subject, report);
    check_detail::check_lifts(subject, report);
    check_detail::check_feeders(subject, report);
    check_detail::check_turns(subject, report);
    check_detail::check_warp(subject, report);
    check_detail::check_relaxed(subject, report);
    std::stable_sort(report.findings.begin(), report.findings.end(), comes_before);
    return report;
}

}  // namespace weave
