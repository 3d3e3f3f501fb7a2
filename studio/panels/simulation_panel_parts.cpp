// The parts of the panel and how they are laid out; what they do is in simulation_panel.cpp.

#include <studio/panels/simulation_panel.hpp>

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QAction>
#include <QComboBox>
#include <QFrame>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPainter>
#include <QPainterPath>
#include <QProgressBar>
#include <QScrollArea>
#include <QSpinBox>
#include <QSplitter>
#include <QStyle>
#include <QTabWidget>
#include <QToolButton>
#include <QVBoxLayout>

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

namespace weave::studio {

namespace {

QScrollArea* scrolling(QWidget* page) {
    auto* area = new QScrollArea;
    area->setWidget(page);
    area->setWidgetResizable(true);
    area->setFrameShape(QFrame::NoFrame);
    area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
    return area;
}

QToolButton* button_of(QAction* action, Qt::ToolButtonStyle look) {
    auto* button = new QToolButton;
    button->setDefaultAction(action);
    button->setToolButtonStyle(look);
    button->setFocusPolicy(Qt::StrongFocus);
    return button;
}

enum class Sign { run, pause, step, stop };

/// The shape of a sign, within a square of 16.
QPainterPath shape_of(Sign sign) {
    QPainterPath path;
    const auto triangle = [&path](double left) {
        path.addPolygon(QPolygonF{{left, 3}, {left + 9, 8}, {left, 13}});
        path.closeSubpath();
    };
    if (sign == Sign::run) triangle(4);
    if (sign == Sign::step) triangle(2), path.addRect(11.5, 3, 2.5, 10);
    if (sign == Sign::pause) path.addRect(3.5, 3, 3.5, 10), path.addRect(9, 3, 3.5, 10);
    if (sign == Sign::stop) path.addRect(3.5, 3.5, 9, 9);
    return path;
}

/// In the colour that text has: the style's own signs are black on a dark ground.
QIcon icon_of(Sign sign, const QPalette& palette) {
    constexpr int side = 16, times = 4;  // for dense displays
    QIcon icon;
    for (const auto& [mode, group] : {std::pair(QIcon::Normal, QPalette::Active), std::pair(QIcon::Disabled, QPalette::Disabled)}) {
        QPixmap pixmap(side * times, side * times);
        pixmap.fill(Qt::transparent);
        QPainter painter(&pixmap);
        painter.setRenderHint(QPainter::Antialiasing);
        painter.scale(times, times);
        painter.fillPath(shape_of(sign), palette.color(group, QPalette::ButtonText));
        painter.end();
        pixmap.setDevicePixelRatio(times);
        icon.addPixmap(pixmap, mode);
    }
    return icon;
}

}  // namespace

SimulationPanel::SimulationPanel(QWidget* parent)
    : QWidget(parent),
      m_driver(new SimulationDriver(this)),
      m_files(new YarnsFiles(this)),
      m_message(new MessageBar(this)),
      m_backend(new BackendRow(this)),
      m_fidelity(new FidelityGroup(this)),
      m_steps(new QSpinBox(this)),
      m_sentence(new QLabel(this)),
      m_out_of_date(new QLabel(this)),
      m_progress(new QProgressBar(this)),
      m_tabs(new QTabWidget(this)),
      m_plot(new ResidualPlot(this)),
      m_findings(new SimulationFindings(this)),
      m_warp(new SystemGroup(System::warp, this)),
      m_weft(new SystemGroup(System::weft, this)),
      m_scene(new SceneGroup(this)),
      m_region(new RegionGroup(this)) {
    make_actions();
    auto* lines = new QVBoxLayout(this);
    lines->addWidget(m_message);
    lines->addWidget(make_controls());
    m_tabs->addTab(make_result_page(), tr("&Result"));
    m_tabs->addTab(make_yarns_page(), tr("&Behaviour"));
    m_tabs->addTab(make_cloth_page(), tr("&Cloth"));
    lines->addWidget(m_tabs, 1);
    connect_parts();
    connect_driver();
    guard_keys();
    show_state();
}

void SimulationPanel::make_actions() {
    const auto make = [&](QStyle::StandardPixmap icon, const QString& words, const QString& tip,
                          void (SimulationPanel::*done)()) {
        auto* action = new QAction(style()->standardIcon(icon), words, this);
        action->setToolTip(tip);
        connect(action, &QAction::triggered, this, done);
        return action;
    };
    m_run_action = make(QStyle::SP_MediaPlay, tr("Run"), tr("Run or pause the simulation (Space)"),
                        &SimulationPanel::toggle_run);
    m_step_action = make(QStyle::SP_MediaSkipForward, tr("Step"), tr("So many steps, then pause"),
                         &SimulationPanel::step);
    m_again_action =
        make(QStyle::SP_BrowserReload, tr("Start again"),
             tr("Lay the yarns out anew, as designed now, and run"), &SimulationPanel::start_again);
    m_save_action = make(QStyle::SP_DialogSaveButton, tr("Save yarns …"),
                         tr("Save the relaxed yarns: .yarns, or for other programs .vtp and .obj"),
                         &SimulationPanel::ask_to_save);
    m_open_action = make(QStyle::SP_DialogOpenButton, tr("Open yarns …"),
                         tr("Look at relaxed yarns from a file"), &SimulationPanel::ask_to_open);
    m_stop_action = new QAction(style()->standardIcon(QStyle::SP_MediaStop), tr("Stop"), this);
    m_stop_action->setToolTip(tr("End the simulation; the yarns stay as they lie"));
    connect(m_stop_action, &QAction::triggered, m_driver, &SimulationDriver::stop);
    m_run_action->setShortcut(Qt::Key_Space);
    m_run_action->setShortcutContext(Qt::WindowShortcut);
    addAction(m_run_action);
}

QWidget* SimulationPanel::make_controls() {
    auto* part = new QWidget(this);
    auto* lines = new QVBoxLayout(part);
    lines->setContentsMargins(0, 0, 0, 0);
    lines->addWidget(m_backend);
    lines->addWidget(m_fidelity);
    auto* buttons = new QHBoxLayout;
    buttons->addWidget(button_of(m_run_action, Qt::ToolButtonTextBesideIcon));
    buttons->addWidget(button_of(m_step_action, Qt::ToolButtonTextBesideIcon));
    m_steps->setRange(1, 1000);
    m_steps->setAccessibleName(tr("Steps"));
    m_steps->setToolTip(tr("How many steps at once"));
    buttons->addWidget(m_steps);
    buttons->addWidget(button_of(m_stop_action, Qt::ToolButtonIconOnly));
    buttons->addWidget(button_of(m_again_action, Qt::ToolButtonIconOnly));
    buttons->addStretch(1);
    lines->addLayout(buttons);
    m_sentence->setWordWrap(true);
    m_sentence->setTextFormat(Qt::PlainText);  // it quotes what servers and files say
    m_sentence->setTextInteractionFlags(Qt::TextSelectableByMouse);
    QFont bold = font();
    bold.setBold(true);
    m_sentence->setFont(bold);
    lines->addWidget(m_sentence);
    m_progress->setTextVisible(true);
    m_progress->setAccessibleName(tr("Progress"));
    lines->addWidget(m_progress);
    m_out_of_date->setWordWrap(true);
    m_out_of_date->setTextFormat(Qt::PlainText);
    m_out_of_date->setMinimumHeight(2 * fontMetrics().lineSpacing());
    QSizePolicy kept = m_out_of_date->sizePolicy();
    kept.setRetainSizeWhenHidden(true);  // else the fields below would move away under the hand that changes them
    m_out_of_date->setSizePolicy(kept);
    lines->addWidget(m_out_of_date);
    return part;
}

QWidget* SimulationPanel::make_result_page() {
    auto* page = new QWidget;
    auto* lines = new QVBoxLayout(page);
    auto* parts = new QSplitter(Qt::Vertical);
    parts->addWidget(m_plot);
    parts->addWidget(m_findings);
    parts->setStretchFactor(0, 2);
    parts->setStretchFactor(1, 3);
    parts->setSizes({20 * fontMetrics().height(), 30 * fontMetrics().height()});
    parts->setChildrenCollapsible(false);
    lines->addWidget(parts, 1);
    auto* files = new QHBoxLayout;
    files->addWidget(button_of(m_save_action, Qt::ToolButtonTextBesideIcon));
    files->addWidget(button_of(m_open_action, Qt::ToolButtonTextBesideIcon));
    files->addStretch(1);
    lines->addLayout(files);
    return page;
}

QWidget* SimulationPanel::make_yarns_page() {
    auto* page = new QWidget;
    auto* lines = new QVBoxLayout(page);
    lines->addWidget(m_warp);
    lines->addWidget(m_weft);
    lines->addStretch(1);
    return scrolling(page);
}

QWidget* SimulationPanel::make_cloth_page() {
    auto* page = new QWidget;
    auto* lines = new QVBoxLayout(page);
    lines->addWidget(m_scene);
    lines->addWidget(m_region);
    lines->addStretch(1);
    return scrolling(page);
}

void SimulationPanel::connect_parts() {
    connect(m_warp, &SystemGroup::edited, this, &SimulationPanel::edit_scene);
    connect(m_weft, &SystemGroup::edited, this, &SimulationPanel::edit_scene);
    connect(m_scene, &SceneGroup::edited, this, &SimulationPanel::edit_scene);
    connect(m_region, &RegionGroup::edited, this, &SimulationPanel::compare_choices);
    connect(m_fidelity, &FidelityGroup::edited, this, &SimulationPanel::compare_choices);
    connect(m_backend, &BackendRow::edited, this, &SimulationPanel::compare_choices);
    connect(m_findings, &SimulationFindings::place_wanted, this, &SimulationPanel::place_wanted);
    const auto tell_error = [this](const Error& error) {
        m_message->tell(MessageBar::Kind::error, error_words(error));
    };
    connect(m_files, &YarnsFiles::failed, this, tell_error);
    connect(m_files, &YarnsFiles::was_read, this, &SimulationPanel::show_file);
    connect(m_files, &YarnsFiles::written, this, [this](const QString& file) {
        m_message->tell(MessageBar::Kind::note, tr("Saved: %1").arg(file));
    });
}

void SimulationPanel::connect_driver() {
    connect(m_driver, &SimulationDriver::begun, this, &SimulationPanel::forget_run);
    connect(m_driver, &SimulationDriver::planned, this,
            [this] { m_findings->set_plan(plan_words(*m_driver->plan())); });
    connect(m_driver, &SimulationDriver::state_changed, this, &SimulationPanel::show_state);
    connect(m_driver, &SimulationDriver::moved, m_plot, &ResidualPlot::add);
    connect(m_driver, &SimulationDriver::laid_out, this, &SimulationPanel::laid_out);
    connect(m_driver, &SimulationDriver::frame_came, this, &SimulationPanel::frame_came);
    connect(m_driver, &SimulationDriver::yarns_came, this, [this](const auto& yarns) {
        m_yarns = yarns;
        Q_EMIT yarns_came(yarns);
        Q_EMIT run_stood(yarns);
    });
    connect(m_driver, &SimulationDriver::flip_ended, this,
            [this](const Flip& flip, bool done, const QString& reason) {
                if (!done)
                    m_message->tell(
                        MessageBar::Kind::warning,
                        tr("Pick %1 and end %2 stay as they lie: %3")
                            .arg(QString::number(flip.pick + 1), QString::number(flip.end + 1), reason));
                Q_EMIT flip_ended(flip, done, reason);
            });
    connect(m_driver, &SimulationDriver::flip_refused, this, [this](const Flip& flip, const QString& reason) {
        m_message->tell(MessageBar::Kind::warning,
                        tr("The simulated cloth does not follow at pick %1, end %2: %3")
                            .arg(QString::number(flip.pick + 1), QString::number(flip.end + 1), reason));
    });
    connect(m_driver, &SimulationDriver::behind_changed, this, [this] { set_out_of_date(m_driver->is_behind()); });
    connect(m_driver, &SimulationDriver::refused, this, [this](const Error& error) {
        m_message->tell(MessageBar::Kind::warning, tr("Not done: %1").arg(error_words(error)));
    });
    connect(m_driver, &SimulationDriver::troubled, this, [this](const QString& words) {
        if (words.isEmpty())
            m_message->clear();
        else
            m_message->tell(MessageBar::Kind::warning, tr("%1; trying again").arg(words));
    });
}

void SimulationPanel::show_icons() {
    m_run_action->setIcon(icon_of(m_driver->is_running() ? Sign::pause : Sign::run, palette()));
    m_step_action->setIcon(icon_of(Sign::step, palette()));
    m_stop_action->setIcon(icon_of(Sign::stop, palette()));
}

void SimulationPanel::changeEvent(QEvent* event) {
    QWidget::changeEvent(event);
    if (event->type() == QEvent::PaletteChange) show_icons();
}

// ---- Keys and wheel ----

/// Space is for the part that has the focus where that does something with it; and the wheel, over a part
/// that has none, moves the page and no value.
void SimulationPanel::guard_keys() {
    for (QWidget* part : findChildren<QWidget*>()) {
        const bool takes_wheel = qobject_cast<QAbstractSpinBox*>(part) != nullptr ||
                                 qobject_cast<QAbstractSlider*>(part) != nullptr ||
                                 qobject_cast<QComboBox*>(part) != nullptr;
        const bool takes_space =
            qobject_cast<QAbstractButton*>(part) != nullptr || qobject_cast<QComboBox*>(part) != nullptr;
        if (takes_wheel && part->focusPolicy() == Qt::WheelFocus) part->setFocusPolicy(Qt::StrongFocus);
        if (takes_wheel || takes_space) part->installEventFilter(this);
    }
}

bool SimulationPanel::eventFilter(QObject* watched, QEvent* event) {
    const auto* part = qobject_cast<QWidget*>(watched);
    const bool is_scroll_bar = part != nullptr && part->inherits("QScrollBar");
    if (part != nullptr && event->type() == QEvent::Wheel && !part->hasFocus() && !is_scroll_bar) {
        event->ignore();
        return true;
    }
    const bool takes_space = qobject_cast<const QAbstractButton*>(part) != nullptr ||
                             qobject_cast<const QComboBox*>(part) != nullptr;
    if (takes_space && event->type() == QEvent::ShortcutOverride &&
        static_cast<QKeyEvent*>(event)->key() == Qt::Key_Space)
        event->accept();
    return QWidget::eventFilter(watched, event);
}

}  // namespace weave::studio
