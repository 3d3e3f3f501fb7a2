#include <studio/window/simulation_desk.hpp>

#include <studio/commands/set_scene.hpp>
#include <studio/jobs/leaving_threads.hpp>
#include <utility>

namespace weave::studio {

namespace {

/// The control points of each yarn of a frame.
std::vector<std::vector<Vec3>> control_of(const Frame& frame) {
    std::vector<std::vector<Vec3>> control;
    auto next = frame.points.begin();
    for (const std::uint32_t count : frame.counts) {
        control.emplace_back(next, next + count);
        next += count;
    }
    return control;
}

/// Yarns as a layout and a frame tell of them: nobody has measured strain or contact yet.
std::shared_ptr<const Yarns> yarns_of(const YarnLayout& layout, const Frame& frame) {
    if (layout.yarns.size() != frame.counts.size()) return nullptr;
    auto yarns = std::make_shared<Yarns>();
    yarns->size_mm = frame.head.size_mm;
    yarns->is_periodic = layout.is_periodic;
    std::vector<std::vector<Vec3>> control = control_of(frame);
    for (std::size_t k = 0; k < control.size(); ++k) {
        const wire::LayoutYarn& from = layout.yarns[k];
        SimulatedYarn yarn;
        yarn.system = from.system;
        yarn.number = from.number;
        yarn.beam = static_cast<std::uint32_t>(from.beam);
        yarn.radius_mm = from.radius_mm;
        yarn.colour = from.colour;
        yarn.strain.assign(control[k].size(), 0);
        yarn.contact_N.assign(control[k].size(), 0);
        yarn.planned = control[k];
        yarn.spline.control = std::move(control[k]);
        yarn.spline.is_periodic = from.is_periodic;
        yarn.spline.shift = {static_cast<double>(from.turns[0]) * frame.head.size_mm[0], static_cast<double>(from.turns[1]) * frame.head.size_mm[1], 0};
        yarns->yarns.push_back(std::move(yarn));
    }
    return yarns;
}

}  // namespace

SimulationDesk::SimulationDesk(SimulationPanel& panel, ViewerPanel& viewer, QObject* parent) : QObject(parent), m_panel(panel), m_viewer(viewer) {
    connect(&panel, &SimulationPanel::scene_edited, this, [this](const Scene& scene, bool is_dragging) {
        if (m_document == nullptr) return;
        if (scene == m_document->design().scene) {
            if (!is_dragging) m_document->end_stroke();
            return;
        }
        const Status made = m_document->perform(set_scene(m_document->design().scene, scene, is_dragging));
        if (!made) Q_EMIT failed(QString::fromStdString(made.error().text()));
    });
    connect(&panel, &SimulationPanel::place_wanted, this, [this](std::size_t pick, std::size_t end) { Q_EMIT place_wanted({pick, end}); });
    connect(&panel, &SimulationPanel::dated_changed, this, [this](bool is_dated) {
        m_viewer.set_caption(ViewerPanel::Mode::relaxed, is_dated ? tr("Before the last change: start the simulation anew") : QString());
    });
    connect(&panel, &SimulationPanel::begun, this, &SimulationDesk::note_cloth);
    connect(&panel, &SimulationPanel::laid_out, this, &SimulationDesk::take_layout);
    connect(&panel, &SimulationPanel::frame_came, this, &SimulationDesk::take_frame);
    connect(&panel, &SimulationPanel::yarns_came, this, &SimulationDesk::take_yarns);
    connect(&panel, &SimulationPanel::flip_ended, this, &SimulationDesk::take_flip);
}

void SimulationDesk::show_document(Document* document) {
    if (m_document != nullptr) m_document->disconnect(this);
    m_document = document;
    m_panel.clear_design();  // a flip under way would end in the new document
    forget_yarns();
    m_panel.setEnabled(document != nullptr);
    if (document == nullptr) return;
    const auto tell_design = [this] { m_panel.set_design(m_document->design()); };
    connect(document, &Document::edited, this, tell_design);
    connect(document, &Document::whole_made, this, &SimulationDesk::follow_size);
    tell_design();
    follow_size();
}

/// A run begins; where the cloth of its design is still being made, that is the next one to come.
void SimulationDesk::note_cloth() {
    m_relaxed_cloth.reset();
    if (m_document == nullptr || m_document->whole().revision != m_document->revision()) return;
    if (const BlockPtr& cloth = m_document->whole().block) m_relaxed_cloth = cloth->grid();
}

/// Yarns of another size would be taken for the cloth as it is, and those of a large cloth are gigabytes: they go.
void SimulationDesk::follow_size() {
    const BlockPtr& cloth = m_document->whole().block;
    if (!cloth) return;
    m_panel.set_cloth(cloth->grid());
    if (m_document->whole().revision != m_document->revision()) return;  // a newer one is being made
    if (!m_relaxed_cloth) m_relaxed_cloth = cloth->grid();
    if (*m_relaxed_cloth == cloth->grid()) return;
    const bool had_yarns = m_yarns != nullptr || m_shown_layout != 0;
    forget_yarns();
    m_panel.let_go();
    run_apart(return_freed_memory);
    if (had_yarns) Q_EMIT outgrown(tr("The cloth has another size than when it was relaxed: its relaxed yarns are gone, and the 3D view shows its plan again."));
}

void SimulationDesk::forget_yarns() {
    m_layout.reset();
    m_yarns.reset();
    m_shown_layout = 0;
    m_viewer.set_relaxed(nullptr);
    m_viewer.set_mode(ViewerPanel::Mode::planned);
}

void SimulationDesk::take_layout(const std::shared_ptr<const YarnLayout>& layout) {
    m_layout = layout;
    m_shown_layout = 0;
    m_yarns.reset();
}

void SimulationDesk::take_frame(const std::shared_ptr<const Frame>& frame) {
    if (!m_layout || m_layout->layout != frame->head.layout) return;
    if (m_shown_layout == m_layout->layout) {
        if (const Status moved = m_viewer.set_points(control_of(*frame)); !moved) m_shown_layout = 0;
        return;
    }
    auto yarns = yarns_of(*m_layout, *frame);
    if (!yarns) return;
    const bool is_first = std::exchange(m_shown_layout, m_layout->layout) == 0;
    m_viewer.set_relaxed(std::move(yarns));
    if (is_first) m_viewer.set_mode(ViewerPanel::Mode::relaxed);
}

void SimulationDesk::take_yarns(const std::shared_ptr<const Yarns>& yarns) {
    m_yarns = yarns;
    m_shown_layout = 0;  // these have other points where a smallest repeat was copied back
    m_viewer.set_relaxed(yarns);
    m_viewer.set_mode(ViewerPanel::Mode::relaxed);
    Q_EMIT relaxed();
}

bool SimulationDesk::flip(const CardPlace& place) {
    const bool is_open = m_panel.state().phase != RunPhase::idle && m_panel.state().phase != RunPhase::failed && m_panel.state().phase != RunPhase::stopped;
    const BlockPtr& cloth = m_document == nullptr ? BlockPtr() : m_document->whole().block;
    if (!is_open || m_panel.is_out_of_date() || !cloth || m_document->shown_block() != m_document->design().root) return false;
    m_panel.flip(Flip{place.pick, place.end, !cloth->weft_over(place.pick, place.end)});
    Q_EMIT told(tr("Pick %1 and end %2 are led past one another …").arg(place.pick + 1).arg(place.end + 1));
    return true;
}

void SimulationDesk::take_flip(const Flip& flip, bool done, const QString& reason) {
    if (m_document == nullptr) return;
    if (!done) return failed(tr("Pick %1 and end %2 did not change sides: %3").arg(flip.pick + 1).arg(flip.end + 1).arg(reason));
    const Status made = m_document->perform({tr("Flip pick %1, end %2").arg(flip.pick + 1).arg(flip.end + 1), {PutFlip{m_document->design().root, flip}}});
    if (!made) return failed(QString::fromStdString(made.error().text()));
    Q_EMIT told(tr("Pick %1 and end %2 have changed sides").arg(flip.pick + 1).arg(flip.end + 1));
}

}  // namespace weave::studio
