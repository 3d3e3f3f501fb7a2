#include <studio/window/submit_desk.hpp>

#include <QComboBox>

#include <studio/panels/simulation_backend_row.hpp>

namespace weave::studio {

namespace {

/// A text of a report; empty where it has none.
QString text_of(const Json& report, const char* name) {
    const auto found = report.find(name);
    return found != report.end() && found->is_string() ? QString::fromStdString(found->get<std::string>()) : QString();
}

bool is_true(const Json& report, const char* name) {
    const auto found = report.find(name);
    return found != report.end() && found->is_boolean() && found->get<bool>();
}

}  // namespace

SubmitDesk::SubmitDesk(SubmitPanel& panel, FindingsPanel& findings, SimulationPanel& simulation, QObject* parent)
    : QObject(parent), m_panel(panel), m_simulation(simulation) {
    connect(&findings, &FindingsPanel::counted, this, [this, &findings](std::size_t errors, std::size_t warnings) {
        if (m_document != nullptr) m_panel.set_findings(errors, warnings, findings.summary());
    });
    connect(&simulation, &SimulationPanel::yarns_came, this, &SubmitDesk::take_yarns);
}

void SubmitDesk::show_document(Document* document) {
    if (m_document != nullptr) m_document->disconnect(this);
    m_document = document;
    m_panel.clear_design();
    if (document == nullptr) return;
    m_panel.suggest_name(document->name());
    connect(document, &Document::whole_made, this, &SubmitDesk::tell_design);
    tell_design();
}

void SubmitDesk::tell_design() {
    if (m_document->whole().revision == m_document->revision() || !m_document->whole().block)
        m_panel.set_design(m_document->design(), m_document->whole().block, m_document->revision());
}

void SubmitDesk::take_yarns(const std::shared_ptr<const Yarns>& yarns) {
    if (m_document == nullptr || !yarns) return;
    SimulationFound found;
    found.machine = m_simulation.backend()->choice()->currentText();
    found.fidelity = text_of(yarns->report, "fidelity");
    found.at = QDateTime::currentDateTime();
    found.at_rest = is_true(yarns->report, "converged");
    found.order_kept = is_true(yarns->report, "order_kept");
    found.edition = m_document->revision();
    m_panel.evidence().set_found(found);
}

}  // namespace weave::studio
