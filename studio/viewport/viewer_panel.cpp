#include <studio/viewport/viewer_panel.hpp>


#include <QComboBox>
#include <QLabel>
#include <QSignalBlocker>
#include <QSlider>
#include <QSpinBox>
#include <QStackedWidget>
#include <QStandardItemModel>
#include <QToolButton>
#include <QToolBar>
#include <QVBoxLayout>

namespace weave::studio {

namespace {

bool needs_relaxed(ColourBy colour) {
    return colour >= ColourBy::strain;
}

QLabel* trouble_page(const QString& trouble) {
    auto* const label =
        new QLabel(ViewerPanel::tr("<h3>The 3D view cannot be drawn</h3><p>%1.</p><p>Everything else works; "
                                   "the card and the slices show the "
                                   "cloth as well. A newer graphics driver, or software drawing "
                                   "(LIBGL_ALWAYS_SOFTWARE=1), may help.</p>")
                       .arg(trouble.toHtmlEscaped()));
    label->setAlignment(Qt::AlignCenter);
    label->setWordWrap(true);
    label->setMargin(label->fontMetrics().height());
    label->setAccessibleName(ViewerPanel::tr("Why there is no 3D view"));
    return label;
}

}  // namespace

ViewerPanel::ViewerPanel(QWidget* parent, const QString& trouble) : QWidget(parent) {
    auto* const column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    m_pages = new QStackedWidget;
    m_viewport = new Viewport;
    m_tools = new QToolBar(tr("3D view"));
    build_tools();
    column->addWidget(m_tools);
    column->addWidget(m_pieces);
    column->addWidget(m_pages, 1);
    if (trouble.isEmpty()) {
        m_pages->addWidget(m_viewport);
    } else {  // a widget of OpenGL that is never shown asks for none
        m_viewport->setParent(this);
        m_viewport->hide();
        m_pages->addWidget(trouble_page(trouble));
        m_tools->setEnabled(false);
        m_pieces->setEnabled(false);
    }
    connect(m_viewport, &Viewport::trouble_found, this, [this](const QString& words) {
        m_tools->setEnabled(false);
        m_pieces->setEnabled(false);
        setAccessibleDescription(words);
    });
    connect(&m_maker, &ModelMaker::made, this, &ViewerPanel::show_model);
    connect(&m_maker, &ModelMaker::failed, this, [this](const QString& words) {
        m_failure = words;
        show_model(nullptr);
    });
    setFocusProxy(m_viewport);
    say_empty();
    follow_model();
}

// ---- What is shown ----

void ViewerPanel::set_planned(std::shared_ptr<const Design> design,
                              std::shared_ptr<const ClothCurves> curves) {
    m_design = std::move(design);
    m_curves = std::move(curves);
    if (m_mode == Mode::planned) make_model();
}

void ViewerPanel::set_no_plan(const QString& why) {
    m_why_no_plan = why;
    set_planned(nullptr, nullptr);
}

void ViewerPanel::set_caption(Mode mode, const QString& words) {
    m_captions[static_cast<std::size_t>(mode)] = words;
    show_caption();
}

void ViewerPanel::show_caption() {
    m_viewport->set_caption(m_captions[static_cast<std::size_t>(m_mode)]);
}

void ViewerPanel::set_relaxed(std::shared_ptr<const Yarns> yarns) {
    m_yarns = std::move(yarns);
    m_points.clear();
    if (m_mode == Mode::relaxed) make_model();
}

Status ViewerPanel::set_points(const std::vector<std::vector<Vec3>>& control) {
    if (m_yarns == nullptr || control.size() != m_yarns->yarns.size())
        return invalid("these are not the places of the relaxed yarns");
    m_points = control;
    if (m_shown_mode == Mode::relaxed && m_viewport->model() != nullptr && !m_maker.is_busy())
        return m_viewport->update_points(control);
    return {};
}

void ViewerPanel::make_model() {
    m_failure.clear();
    const ColourBy colour = m_mode == Mode::planned && needs_relaxed(m_colour) ? ColourBy::yarn : m_colour;
    if (m_mode == Mode::planned && m_design != nullptr && m_curves != nullptr) {
        m_maker.ask([design = m_design, curves = m_curves, colour] {
            return TubeModel::planned(*design, *curves, colour);
        });
    } else if (m_mode == Mode::relaxed && m_yarns != nullptr) {
        m_maker.ask([yarns = m_yarns, colour] { return TubeModel::relaxed(yarns, colour); });
    } else {
        m_maker.forget();
        show_model(nullptr);
    }
}

void ViewerPanel::show_model(std::shared_ptr<TubeModel> model) {
    m_shown_mode = m_mode;
    if (model != nullptr && m_mode == Mode::relaxed && !m_points.empty()) {
        if (const Status moved = model->update(m_points); !moved) m_points.clear();  // of yarns that are gone
    }
    say_empty();
    m_viewport->set_model(std::move(model));
    follow_model();
    Q_EMIT model_shown();
}

void ViewerPanel::say_empty() {
    QString why = tr("The cloth has not been relaxed. Run the simulation, or look at the plan.");
    if (m_mode == Mode::planned) why = m_why_no_plan.isEmpty() ? tr("As soon as the block has yarns, its plan is drawn here.") : m_why_no_plan;
    if (!m_failure.isEmpty())
        m_viewport->set_empty_words(tr("This cloth cannot be shown"), m_failure.left(1).toUpper() + m_failure.mid(1) + '.');
    else
        m_viewport->set_empty_words(tr("Nothing to show yet"), why);
}

/// Brings the tools in line with what the model can do.
void ViewerPanel::follow_model() {
    const TubeModel* const model = m_viewport->model();
    const auto limit = [&](QSpinBox* box, std::size_t axis, const QString& tip) {
        const bool repeats = model != nullptr && model->is_periodic()[axis];
        box->setEnabled(repeats);
        box->setToolTip(repeats || model == nullptr
                            ? tip
                            : tr("This piece does not repeat here: its rim is free or held."));
    };
    limit(m_along_ends, 0, tr("Repeats along the ends"));
    limit(m_along_picks, 1, tr("Repeats along the picks"));
    auto* const items = qobject_cast<QStandardItemModel*>(m_colours->model());
    for (int k = 0; k < m_colours->count() && items != nullptr; ++k) {
        const bool can = m_mode == Mode::relaxed || !needs_relaxed(static_cast<ColourBy>(k));
        items->item(k)->setEnabled(can);
        items->item(k)->setToolTip(can ? QString() : tr("Only relaxed yarns have it: choose Relaxed first."));
    }
    const QSignalBlocker quiet(m_colours);
    m_colours->setCurrentIndex(
        static_cast<int>(m_mode == Mode::planned && needs_relaxed(m_colour) ? ColourBy::yarn : m_colour));
    m_save->setEnabled(model != nullptr);
    apply_repeat();
    apply_clip();
}

void ViewerPanel::set_mode(Mode mode) {
    if (mode == m_mode) return;
    m_mode = mode;
    {
        const QSignalBlocker quiet(m_modes);
        m_modes->setCurrentIndex(static_cast<int>(mode));
    }
    show_caption();
    make_model();
}

void ViewerPanel::set_colour(ColourBy colour) {
    if (colour == m_colour) return;
    m_colour = colour;
    follow_model();
    make_model();
}

void ViewerPanel::apply_repeat() {
    m_viewport->set_repeat(
        {static_cast<std::size_t>(m_along_ends->value()), static_cast<std::size_t>(m_along_picks->value())});
    apply_clip();
}

void ViewerPanel::choose_clip(int axis) {
    // What is cut away is what lies between the viewer and the plane.
    if (axis > 0) m_clip_side = m_viewport->camera().away()[axis - 1] > 1e-9 ? -1 : 1;
    apply_clip();
}

void ViewerPanel::apply_clip() {
    const int axis = m_clips->currentIndex() - 1;
    m_clip_at->setEnabled(axis >= 0);
    m_other_side->setEnabled(axis >= 0);
    if (axis < 0 || m_viewport->model() == nullptr) {
        m_viewport->set_clip({});
        return;
    }
    const Box box = m_viewport->shown_box();
    const double at = box.low[axis] + box.size()[axis] * m_clip_at->value() / m_clip_at->maximum();
    m_viewport->set_clip(Plane{Vec3::Unit(axis) * m_clip_side, at * m_clip_side});
}

}  // namespace weave::studio
