#include <studio/panels/simulation_panel.hpp>

#include <QAction>
#include <QComboBox>
#include <QFileDialog>
#include <QFileInfo>
#include <QLabel>
#include <QProgressBar>
#include <QRadioButton>
#include <QSpinBox>
#include <QTabWidget>

#include <studio/jobs/yarns_files.hpp>
#include <studio/panels/simulation_backend_row.hpp>
#include <studio/panels/simulation_driver.hpp>
#include <studio/panels/simulation_fidelity_group.hpp>
#include <studio/panels/simulation_findings.hpp>
#include <studio/panels/message_bar.hpp>
#include <studio/panels/simulation_region_group.hpp>
#include <studio/panels/simulation_residual_plot.hpp>
#include <studio/panels/simulation_scene_group.hpp>
#include <studio/panels/simulation_system_group.hpp>
#include <utility>

namespace weave::studio {

SimulationPanel::~SimulationPanel() {
    m_driver->disconnect(this);  // what it tells while it goes finds no panel
}

const RunState& SimulationPanel::state() const {
    return m_driver->state();
}

// ---- The design ----

void SimulationPanel::set_design(const Design& design) {
    m_design = design;
    m_has_design = true;
    m_warp->set_values(design.scene.warp);
    m_weft->set_values(design.scene.weft);
    m_scene->set_scene(design.scene);
    m_driver->follow(m_design);
    set_out_of_date(m_driver->is_behind());
}

void SimulationPanel::clear_design() {
    m_files->forget();  // what is still being read was for the design that was here
    m_design = {};
    m_has_design = m_choices_differ = false;
    m_message->clear();
    m_driver->leave();
    m_region->whole()->setChecked(true);
    set_out_of_date(false);
}

void SimulationPanel::let_go() {
    m_driver->leave();
    m_choices_differ = false;
    m_message->clear();
    set_out_of_date(false);
}

/// Nothing of an earlier run is shown as if it were of this one.
void SimulationPanel::forget_run() {
    m_plot->clear();
    m_findings->set_plan({});
    m_findings->set_inspection({}, false);
    m_shown_inspection.reset();
    m_yarns.reset();
    show_state();
    Q_EMIT begun();
}

void SimulationPanel::set_out_of_date(bool is_dated) {
    const bool changes = std::exchange(m_is_out_of_date, is_dated) != is_dated;
    if (changes && !is_dated) m_message->clear();  // what it did not follow is gone
    show_state();
    if (changes) Q_EMIT dated_changed(is_dated);
}

void SimulationPanel::set_cloth(const BlockGrid& grid) {
    m_region->set_cloth(grid);
}

/// The run has it before the owner of the design does; both come to the same.
void SimulationPanel::edit_scene(bool is_dragging) {
    Scene scene = m_design.scene;
    scene.warp = m_warp->values();
    scene.weft = m_weft->values();
    m_scene->put_into(scene);
    if (scene == m_design.scene && is_dragging) return;
    m_design.scene = scene;
    m_driver->follow(m_design);
    set_out_of_date(m_driver->is_behind());
    Q_EMIT scene_edited(scene, is_dragging);
}

/// Where, how finely and which part is asked for at the start.
void SimulationPanel::compare_choices() {
    m_choices_differ = m_driver->state().phase != RunPhase::idle;
    show_actions();
}

// ---- The run ----

bool SimulationPanel::begin() {
    if (!m_has_design) return false;
    sim::RunRequest request;
    request.plan.fidelity = m_fidelity->fidelity();
    request.plan.region = m_region->region();
    request.start_from = m_fidelity->start_from();
    request.goal.most_iterations = wire::most_number;  // on as long as somebody wants it to
    m_message->clear();
    m_choices_differ = false;
    m_machine = m_backend->choice()->currentText();
    m_driver->start(m_design, request, m_backend->server());
    set_out_of_date(false);
    return true;
}

/// Whether to go on with the run there is would show something else than was asked for, or nothing at all.
bool SimulationPanel::begins_anew() const {
    return !m_driver->is_open() || m_is_out_of_date || (m_choices_differ && m_driver->state().phase == RunPhase::at_rest);
}

void SimulationPanel::toggle_run() {
    if (m_driver->is_running()) return m_driver->pause();
    if (begins_anew() && !begin()) return;
    m_driver->run();
}

void SimulationPanel::step() {
    if (begins_anew() && !begin()) return;
    m_driver->step(static_cast<std::uint64_t>(m_steps->value()));
}

void SimulationPanel::start_again() {
    if (begin()) m_driver->run();
}

void SimulationPanel::flip(const Flip& flip) {
    m_driver->flip(flip);
}

// ---- Files ----

void SimulationPanel::save_to(const QString& file) {
    if (m_yarns) m_files->write(m_yarns, file);
}

void SimulationPanel::open(const QString& file) {
    m_files->read(file);
}

void SimulationPanel::ask_to_save() {
    const QString kinds = tr("Relaxed yarns (*.yarns);;ParaView centrelines (*.vtp);;Yarns as tubes (*.obj)");
    QString kind;
    QString file = QFileDialog::getSaveFileName(
        this, tr("Save yarns"),
        QString::fromStdString(m_design.title.empty() ? "cloth" : m_design.title) + QStringLiteral(".yarns"),
        kinds, &kind);
    if (file.isEmpty()) return;
    if (QFileInfo(file).suffix().isEmpty())
        file += kind.contains(QStringLiteral("vtp"))   ? QStringLiteral(".vtp")
                : kind.contains(QStringLiteral("obj")) ? QStringLiteral(".obj")
                                                       : QStringLiteral(".yarns");
    save_to(file);
}

void SimulationPanel::ask_to_open() {
    const QString file =
        QFileDialog::getOpenFileName(this, tr("Open yarns"), {}, tr("Relaxed yarns (*.yarns)"));
    if (!file.isEmpty()) open(file);
}

void SimulationPanel::show_file(const std::shared_ptr<const Yarns>& yarns,
                                const std::shared_ptr<const Inspection>& inspection) {
    if (m_driver->is_running()) m_driver->pause();
    m_yarns = yarns;
    m_findings->set_inspection(inspection ? inspection_words(*inspection) : std::vector<StateLine>(),
                               inspection != nullptr);
    m_message->tell(MessageBar::Kind::note,
                    tr("These are yarns from a file: %1").arg(QString::fromStdString(yarns->title)));
    show_actions();
    Q_EMIT yarns_came(yarns);
}

// ---- What shows ----

void SimulationPanel::show_state() {
    const RunState& state = m_driver->state();
    m_sentence->setText(m_is_out_of_date ? dated_words(state) : state_words(state));
    m_sentence->setAccessibleName(m_sentence->text());
    m_plot->set_goal(state.progress.goal);
    show_progress();
    show_findings();
    show_actions();
    if (m_shown_phase == state.phase) return;
    m_shown_phase = state.phase;
    Q_EMIT phase_changed(state.phase);
}

void SimulationPanel::show_progress() {
    constexpr int whole = 1000;
    const RunState& state = m_driver->state();
    const bool is_working = state.phase == RunPhase::planning || state.phase == RunPhase::running;
    const std::optional<double> share = m_driver->share_done();
    m_progress->setRange(0, is_working && !share ? 0 : whole);  // 0: it works, and nobody knows how long
    m_progress->setValue(m_is_out_of_date && !is_working ? 0 : static_cast<int>(share.value_or(0) * whole));
    // How long it will take is said once, above.
    m_progress->setFormat(state.phase == RunPhase::running && share ? QStringLiteral("%p %")
                          : state.phase == RunPhase::at_rest && m_is_out_of_date ? tr("the design has changed")
                          : state.phase == RunPhase::at_rest  ? tr("at rest")
                          : state.phase == RunPhase::planning ? tr("laying out")
                                                              : QString());
}

void SimulationPanel::show_findings() {
    const auto& inspection = m_driver->state().inspection;
    if (m_shown_inspection == inspection) return;
    m_shown_inspection = inspection;
    m_findings->set_inspection(inspection ? inspection_words(*inspection) : std::vector<StateLine>(),
                               inspection != nullptr);
}

void SimulationPanel::show_actions() {
    const RunPhase phase = m_driver->state().phase;
    const bool runs = m_driver->is_running(), is_done = phase == RunPhase::at_rest && !begins_anew();
    const bool goes_on = phase == RunPhase::paused && !begins_anew();
    m_run_action->setText(runs ? tr("Pause") : goes_on ? tr("Go on") : tr("Run"));
    show_icons();
    m_run_action->setEnabled(m_has_design && (runs || !is_done));
    m_step_action->setEnabled(m_has_design && !runs && !is_done);
    m_steps->setEnabled(m_step_action->isEnabled());
    m_stop_action->setEnabled(m_driver->is_open());
    m_again_action->setEnabled(m_has_design && phase != RunPhase::idle);
    m_save_action->setEnabled(m_yarns != nullptr);
    m_out_of_date->setVisible(phase != RunPhase::idle && (m_is_out_of_date || m_choices_differ));
    m_out_of_date->setText(
        m_is_out_of_date
            ? runs ? tr("The design has changed in a way that this run does not show. Start again to see it.")
                   : tr("The design has changed in a way that this run does not show. Run starts again with it.")
            : tr("What was chosen counts from the next start on."));
}

}  // namespace weave::studio
