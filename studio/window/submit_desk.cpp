#include <studio/window/submit_desk.hpp>

#include <weave/design/document.hpp>
#include <weave/sim/take_up.hpp>

#include <studio/jobs/background.hpp>

namespace weave::studio {

namespace {

/// A text of a report; empty where it has none.
QString text_of(const Json& report, const char* name) {
    const auto found = report.find(name);
    return found != report.end() && found->is_string() ? QString::fromStdString(found->get<std::string>()) : QString();
}

/// What a design may be called at a mill; nothing where it has no name yet.
QString name_of(const Document& document) {
    const bool has_name = !document.design().title.empty() || !document.path().isEmpty();
    return has_name ? document.name() : QString();
}

/// Nothing where the yarns are of another design or scene, or no loom should be set up by them, such as those of a part or not at rest.
std::optional<RelaxedCloth> found_of(const Design& design, const Block& block, const Yarns& yarns) {
    if (yarns.scene_sha256 != scene_sha256(design)) return {};
    auto relaxed = relaxed_cloth(yarns, design, block);
    return relaxed ? std::optional(std::move(*relaxed)) : std::nullopt;
}

bool is_true(const Json& report, const char* name) {
    const auto found = report.find(name);
    return found != report.end() && found->is_boolean() && found->get<bool>();
}

}  // namespace

SubmitDesk::SubmitDesk(SubmitPanel& panel, FindingsPanel& findings, SimulationPanel& simulation, QObject* parent)
    : QObject(parent), m_panel(panel), m_findings(findings), m_simulation(simulation) {
    connect(&findings, &FindingsPanel::counted, this, [this, &findings](std::size_t errors, std::size_t warnings) {
        if (m_document == nullptr || !findings.report()) return m_panel.forget_findings();
        m_panel.set_findings(errors, warnings, findings.summary());
    });
    connect(&simulation, &SimulationPanel::begun, this, [this] { m_begun = m_document == nullptr ? 0 : m_document->revision(); });
    connect(&simulation, &SimulationPanel::run_stood, this, &SubmitDesk::take_yarns);
}

void SubmitDesk::show_document(Document* document) {
    if (m_document != nullptr) m_document->disconnect(this);
    m_document = document;
    m_panel.clear_design();
    m_begun = 0;
    forget_take_up();
    if (document == nullptr) return;
    m_panel.suggest_name(name_of(*document));
    connect(document, &Document::path_changed, this, [this] { m_panel.suggest_anew(name_of(*m_document)); });
    connect(document, &Document::edited, this, &SubmitDesk::forget_take_up);
    connect(document, &Document::whole_made, this, &SubmitDesk::tell_design);
    tell_design();
}

void SubmitDesk::tell_design() {
    if (m_document->whole().revision == m_document->revision() || !m_document->whole().block)
        m_panel.set_design(m_document->design(), m_document->whole().block, m_document->revision());
    judge_take_up();
}

/// They are of the design as it was when the run began, or of what was led into the run since: their hashes tell.
void SubmitDesk::take_yarns(const std::shared_ptr<const Yarns>& yarns) {
    if (m_document == nullptr || !yarns) return;
    const Design& design = m_document->design();
    const bool is_current = yarns->design_sha256 == design_sha256(design) && yarns->scene_sha256 == scene_sha256(design);
    SimulationFound found;
    found.machine = m_simulation.machine();
    found.fidelity = text_of(yarns->report, "fidelity");
    found.at = QDateTime::currentDateTime();
    found.at_rest = is_true(yarns->report, "converged");
    found.order_kept = is_true(yarns->report, "order_kept");
    found.edition = is_current ? m_document->revision() : m_begun;
    m_panel.evidence().set_found(found);
    judge_take_up();
}

/// Each time that the cloth is made or comes to rest: undo may have brought back the design that the yarns are of.
void SubmitDesk::judge_take_up() {
    const Cloth& whole = m_document->whole();
    const std::shared_ptr<const Yarns>& yarns = m_simulation.state().yarns;
    if (!yarns || !whole.block || whole.revision != m_document->revision()) return;
    in_background(
        this, [yarns, design = m_document->design(), block = whole.block] { return found_of(design, *block, *yarns); },
        [this, wanted = ++m_wanted](const std::optional<RelaxedCloth>& relaxed) {
            if (wanted == m_wanted && relaxed) m_findings.set_relaxed(relaxed);
        });
}

/// What was found of the design before is nothing to judge it by.
void SubmitDesk::forget_take_up() {
    ++m_wanted;
}

}  // namespace weave::studio
