// The tool row of viewer_panel.hpp.
#include <studio/viewport/icons.hpp>
#include <studio/viewport/viewer_panel.hpp>
#include <studio/viewport/words.hpp>

#include <QAction>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QSlider>
#include <QSpinBox>
#include <QStyle>
#include <QToolBar>
#include <QToolButton>

namespace weave::studio {

namespace {

constexpr int clip_steps = 1000;

template <class Widget>
Widget* named(Widget* widget, const QString& name, const QString& tip) {
    widget->setAccessibleName(name);
    widget->setToolTip(tip);
    widget->setFocusPolicy(Qt::TabFocus);  // a click leaves the keys to the picture
    return widget;
}

}  // namespace

QAction* ViewerPanel::add_action(int icon, const QString& text, const QString& tip) {
    QAction* const action = m_tools->addAction(view_icon(static_cast<ViewIcon>(icon)), text);
    action->setToolTip(tip);
    if (QWidget* const button = m_tools->widgetForAction(action)) button->setAccessibleName(text);
    return action;
}

void ViewerPanel::build_tools() {
    m_tools->setMovable(false);
    const int side = style()->pixelMetric(QStyle::PM_SmallIconSize);
    m_tools->setIconSize({side, side});
    add_looks();
    m_tools->addSeparator();
    add_views();
    add_rest();
    m_pieces = make_pieces();
}

void ViewerPanel::add_looks() {
    m_modes = named(new QComboBox, tr("What is shown"),
                    tr("Planned: the block as it is drawn. Relaxed: the cloth as the simulation leaves it."));
    m_modes->addItems({tr("Planned"), tr("Relaxed")});
    connect(m_modes, &QComboBox::currentIndexChanged, this,
            [this](int k) { set_mode(static_cast<Mode>(k)); });
    m_tools->addWidget(m_modes);
    m_colours = named(new QComboBox, tr("Colour by"), tr("What colours the yarns"));
    for (std::size_t k = 0; k < colourings; ++k) m_colours->addItem(colour_name(static_cast<ColourBy>(k)));
    connect(m_colours, &QComboBox::currentIndexChanged, this,
            [this](int k) { set_colour(static_cast<ColourBy>(k)); });
    m_tools->addWidget(m_colours);
}

/// How often the piece is shown, and where it is cut.
QWidget* ViewerPanel::make_pieces() {
    make_repeats();
    make_clip();
    auto* const all = new QWidget;
    auto* const row = new QHBoxLayout(all);
    const int gap = m_tools->style()->pixelMetric(QStyle::PM_ToolBarItemSpacing) + 2;
    row->setContentsMargins(gap, 0, gap, gap);
    row->setSpacing(gap);
    row->addWidget(m_along_ends);
    row->addWidget(new QLabel(QStringLiteral("×")));
    row->addWidget(m_along_picks);
    row->addSpacing(2 * gap);
    row->addWidget(m_clips);
    row->addWidget(m_clip_at, 1);
    row->addWidget(m_other_side);
    row->addStretch();
    return all;
}

void ViewerPanel::make_repeats() {
    const auto make = [&](const QString& name) {
        auto* const box = named(new QSpinBox, name, name);
        box->setRange(1, static_cast<int>(most_repeats));
        connect(box, &QSpinBox::valueChanged, this, &ViewerPanel::apply_repeat);
        return box;
    };
    m_along_ends = make(tr("Repeats along the ends"));
    m_along_picks = make(tr("Repeats along the picks"));
    m_along_ends->setPrefix(tr("ends "));
    m_along_picks->setPrefix(tr("picks "));
}

void ViewerPanel::make_clip() {
    m_clips = named(new QComboBox, tr("Cut"), tr("Cuts the cloth open, and shows which yarns are cut"));
    m_clips->addItems(
        {tr("No cut"), tr("Cut across the ends"), tr("Cut across the picks"), tr("Cut by height")});
    connect(m_clips, &QComboBox::currentIndexChanged, this, &ViewerPanel::choose_clip);
    m_clip_at = named(new QSlider(Qt::Horizontal), tr("Place of the cut"), tr("Where the cloth is cut"));
    m_clip_at->setRange(0, clip_steps);
    m_clip_at->setValue(clip_steps / 2);
    m_clip_at->setPageStep(clip_steps / 20);
    m_clip_at->setMinimumWidth(fontMetrics().height() * 4);
    m_clip_at->setMaximumWidth(fontMetrics().height() * 9);
    connect(m_clip_at, &QSlider::valueChanged, this, &ViewerPanel::apply_clip);
    m_other_side = named(new QToolButton, tr("Other side"), tr("Keeps the other side of the cut"));
    m_other_side->setIcon(view_icon(ViewIcon::flip));
    m_other_side->setAutoRaise(true);
    connect(m_other_side, &QToolButton::clicked, this, [this] {
        m_clip_side = -m_clip_side;
        apply_clip();
    });
}

void ViewerPanel::add_views() {
    QAction* const back = add_action(static_cast<int>(ViewIcon::back), tr("View before"),
                                     tr("The view before this one (Alt+Left)"));
    connect(back, &QAction::triggered, m_viewport, &Viewport::view_back);
    QAction* const on = add_action(static_cast<int>(ViewIcon::on), tr("View after"),
                                   tr("The view after this one (Alt+Right)"));
    connect(on, &QAction::triggered, m_viewport, &Viewport::view_on);
    QAction* const fit =
        add_action(static_cast<int>(ViewIcon::fit), tr("Fit"), tr("All of the cloth in view (F)"));
    connect(fit, &QAction::triggered, m_viewport, &Viewport::fit);
    auto* const menu = new QMenu(tr("Views"), this);
    for (std::size_t k = 0; k < standard_views; ++k) {
        const auto view = static_cast<StandardView>(k);
        // The key is the view's own and works where the picture has the focus, so it is told here, not bound.
        QAction* const action = menu->addAction(tr("%1\t%2").arg(view_name(view)).arg(k + 1));
        connect(action, &QAction::triggered, m_viewport, [this, view] { m_viewport->turn_to(view); });
    }
    auto* const button = named(new QToolButton, tr("Views"), tr("Standard views (1 to 6)"));
    button->setIcon(view_icon(ViewIcon::views));
    button->setMenu(menu);
    button->setPopupMode(QToolButton::InstantPopup);
    m_tools->addWidget(button);
}

void ViewerPanel::add_rest() {
    m_perspective = add_action(static_cast<int>(ViewIcon::perspective), tr("Perspective"),
                               tr("Far yarns look smaller; without it lengths can be compared"));
    m_perspective->setCheckable(true);
    connect(m_perspective, &QAction::triggered, m_viewport, &Viewport::set_perspective);
    connect(m_viewport, &Viewport::camera_changed, this,
            [this] { m_perspective->setChecked(m_viewport->camera().perspective); });
    m_lock = add_action(static_cast<int>(ViewIcon::unlocked), tr("Lock the view"),
                        tr("Freezes the view, so that no drag moves it (L)"));
    m_lock->setCheckable(true);
    m_lock->setShortcut(Qt::Key_L);  // of the window, wherever in it one is
    connect(m_lock, &QAction::triggered, m_viewport, &Viewport::set_locked);
    connect(m_viewport, &Viewport::locked_changed, this, [this](bool locked) {
        m_lock->setChecked(locked);
        m_lock->setIcon(view_icon(locked ? ViewIcon::locked : ViewIcon::unlocked));
        m_perspective->setEnabled(!locked);
        m_perspective->setChecked(m_viewport->camera().perspective);
    });
    m_tools->addSeparator();
    m_attach = add_action(static_cast<int>(ViewIcon::attach), tr("Attach"),
                          tr("Choose the side of the block to which another is attached (Esc ends it)"));
    m_attach->setCheckable(true);
    connect(m_attach, &QAction::triggered, m_viewport, &Viewport::set_attach_mode);
    connect(m_viewport, &Viewport::attach_mode_changed, m_attach, &QAction::setChecked);
    m_save = add_action(static_cast<int>(ViewIcon::picture), tr("Save picture"),
                        tr("Saves what is seen as a PNG, twice as fine"));
    connect(m_save, &QAction::triggered, this, [this] {
        if (const QImage picture = m_viewport->picture(2); !picture.isNull()) Q_EMIT picture_taken(picture);
    });
}

}  // namespace weave::studio
