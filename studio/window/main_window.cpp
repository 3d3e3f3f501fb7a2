#include <studio/window/main_window.hpp>

#include <weave/samples/samples.hpp>

#include <QAbstractButton>
#include <QApplication>
#include <QCloseEvent>
#include <QComboBox>
#include <QDockWidget>
#include <QFileInfo>
#include <QKeyEvent>
#include <QLabel>
#include <QMenuBar>
#include <QMessageBox>
#include <QPushButton>
#include <QRubberBand>
#include <QScreen>
#include <QScrollArea>
#include <QSettings>
#include <QShortcut>
#include <QSplitter>
#include <QStackedWidget>
#include <QStatusBar>
#include <QTabWidget>
#include <QToolBar>
#include <QTimer>
#include <QVBoxLayout>

#include <array>

#include <studio/commands/flip_crossing.hpp>
#include <studio/editors/card_editor.hpp>
#include <studio/editors/slice_editor.hpp>
#include <studio/editors/stencil_editor.hpp>
#include <studio/jobs/background.hpp>
#include <studio/panels/design_tree.hpp>
#include <studio/panels/findings_panel.hpp>
#include <studio/panels/message_bar.hpp>
#include <studio/panels/preset_dialog.hpp>
#include <studio/panels/simulation_findings.hpp>
#include <studio/panels/simulation_panel.hpp>
#include <studio/panels/simulation_scene_group.hpp>
#include <studio/panels/submit_panel.hpp>
#include <studio/panels/yarns_panel.hpp>
#include <studio/viewport/viewer_panel.hpp>
#include <studio/window/block_actions.hpp>
#include <studio/window/design_files.hpp>
#include <studio/window/help_window.hpp>
#include <studio/window/picture_stencil.hpp>
#include <studio/window/recent_designs.hpp>
#include <studio/window/simulation_desk.hpp>
#include <studio/window/slice_desk.hpp>
#include <studio/window/start_page.hpp>
#include <studio/window/stencil_desk.hpp>
#include <studio/window/submit_desk.hpp>
#include <studio/window/tutorial.hpp>
#include <studio/window/viewer_desk.hpp>

namespace weave::studio {

namespace {

/// Of the docks and tool bars that there are; one more is another version, as places that know nothing of it would leave it hidden.
constexpr int places_version = 1;

}  // namespace

MainWindow::MainWindow(QWidget* parent)
    : QMainWindow(parent), m_files(new DesignFiles(this)), m_pages(new QStackedWidget), m_work(new QSplitter), m_start(new StartPage),
      m_editors(new QTabWidget), m_card(new CardEditor), m_slice(new SliceEditor), m_slice_desk(new SliceDesk(*m_slice, this)), m_stencil(new StencilEditor),
      m_stencil_desk(new StencilDesk(*m_stencil, this)), m_viewer(new ViewerPanel), m_viewer_desk(new ViewerDesk(*m_viewer, this)), m_tree(new DesignTree),
      m_findings(new FindingsPanel), m_simulation(new SimulationPanel), m_simulation_desk(new SimulationDesk(*m_simulation, *m_viewer, this)), m_yarns(new YarnsPanel),
      m_submit(new SubmitPanel), m_submit_desk(new SubmitDesk(*m_submit, *m_findings, *m_simulation, this)), m_tutorial(new Tutorial), m_messages(new MessageBar), m_status(new QLabel) {
    setObjectName("studio");
    m_messages->setObjectName("messages");
    const QSize title(0, fontMetrics().height() * 2);  // of the window, which the screen has to hold as well
    resize(QSize(fontMetrics().averageCharWidth() * 240, fontMetrics().height() * 62).boundedTo(screen()->availableGeometry().size() - title));
    make_workspace();
    make_docks();
    make_menus();
    m_status->setTextFormat(Qt::PlainText);  // names in it are foreign
    statusBar()->addWidget(m_status, 1);
    connect(m_files, &DesignFiles::opened, this, &MainWindow::opened);
    connect(m_files, &DesignFiles::coloured, this, &MainWindow::offer_stencil);
    connect(m_files, &DesignFiles::failed, this, &MainWindow::warn);
    connect(m_files, &DesignFiles::not_opened, this, &MainWindow::not_opened);
    connect(m_files, &DesignFiles::told, this, &MainWindow::tell);
    connect(m_viewer, &ViewerPanel::picture_taken, m_files, &DesignFiles::save_picture);
    qApp->installEventFilter(this);
    const QSettings settings;
    restoreGeometry(settings.value("window").toByteArray());
    m_work->restoreState(settings.value("work").toByteArray());
    m_places = settings.value("places").toByteArray();
    show_start_page();
}

MainWindow::~MainWindow() {
    show_in_parts(nullptr);
}

/// All that looks at the document; null: at none any more.
void MainWindow::show_in_parts(Document* document) {
    m_card->show_document(document);
    m_slice_desk->show_document(document);
    m_stencil_desk->show_document(document);
    m_viewer_desk->show_document(document);
    m_simulation_desk->show_document(document);
    m_yarns->show_document(document);
    m_tree->show_document(document);
    m_findings->show_document(document);
    m_submit_desk->show_document(document);
    m_tutorial->show_document(document);
}

void MainWindow::make_workspace() {
    m_editors->setObjectName("editors");
    m_editors->setDocumentMode(true);
    m_editors->addTab(m_card, tr("Card"));
    m_editors->addTab(m_slice, tr("Section (slice)"));
    m_editors->addTab(m_stencil, tr("Stencil"));
    auto* whole = new QWidget;
    auto* column = new QVBoxLayout(whole);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(0);
    column->addWidget(m_messages);
    column->addWidget(m_pages, 1);
    m_pages->addWidget(m_start);
    m_pages->addWidget(m_work);
    m_work->addWidget(m_editors);
    m_work->addWidget(m_viewer);
    m_editors->setMinimumWidth(fontMetrics().averageCharWidth() * 50);  // their tool rows may be cut
    m_work->setStretchFactor(0, 1);
    m_work->setStretchFactor(1, 1);
    m_work->setSizes({500, 500});
    m_work->setChildrenCollapsible(false);
    setCentralWidget(whole);
    connect(m_card, &CardEditor::told, this, &MainWindow::tell);
    connect(m_card, &CardEditor::slice_wanted, this, [this](System dots, const CardPlace& place) {
        m_slice_desk->show_section(dots, place);
        m_editors->setCurrentWidget(m_slice);
    });
    connect(m_slice, &SliceEditor::status, this, &MainWindow::tell);
    connect(m_slice_desk, &SliceDesk::failed, this, &MainWindow::tell_refusal);
    connect(m_slice_desk, &SliceDesk::flip_wanted, this, &MainWindow::flip_at_once);
    connect(m_viewer_desk, &ViewerDesk::attach_wanted, this, [this](Face face) {
        if (m_blocks == nullptr) return;
        m_viewer->viewport()->set_attach_mode(false);
        m_blocks->ask_what_to_attach(m_document->shown_block(), face, QCursor::pos());
    });
    connect(m_viewer_desk, &ViewerDesk::flip_wanted, this, &MainWindow::flip);
    connect(m_stencil, &StencilEditor::status, this, &MainWindow::tell);
    connect(m_stencil_desk, &StencilDesk::failed, this, &MainWindow::tell_refusal);
    connect(m_stencil_desk, &StencilDesk::is_stencil, this, [this](bool is) {
        if (!is && m_editors->currentWidget() == m_stencil) m_editors->setCurrentWidget(m_card);
        m_editors->setTabVisible(m_editors->indexOf(m_stencil), is);
    });
    connect(m_simulation_desk, &SimulationDesk::failed, this, &MainWindow::tell_refusal);
    connect(m_simulation_desk, &SimulationDesk::outgrown, this, [this](const QString& words) { m_messages->tell(MessageBar::Kind::note, words, m_simulation->run_action()); });
    connect(m_simulation_desk, &SimulationDesk::told, this, &MainWindow::tell);
    connect(m_simulation_desk, &SimulationDesk::place_wanted, this, [this](const CardPlace& place) { show_yarns(place.pick, place.end); });
    connect(m_start, &StartPage::open_wanted, m_files, &DesignFiles::open);
    connect(m_start, &StartPage::file_wanted, this, &MainWindow::open_file);
    connect(m_start, &StartPage::sample_wanted, this, &MainWindow::show_sample);
    connect(m_start, &StartPage::drawing_wanted, this, [this] {
        Design design;
        design.root = "slice";
        design.blocks["slice"] = std::make_shared<const Node>(Node{SliceLeaf{first_drawing()}, {}});
        show_design(std::move(design), {}, true);
        m_editors->setCurrentWidget(m_slice);
    });
    connect(m_start, &StartPage::tutorial_wanted, this, &MainWindow::begin_tutorial);
    connect(m_tutorial, &Tutorial::closed, this, [this] {
        m_is_learning = false;
        m_tutorial_dock->hide();
    });
    connect(m_tutorial, &Tutorial::help_wanted, this, &MainWindow::show_where);
    connect(m_simulation_desk, &SimulationDesk::relaxed, m_tutorial, &Tutorial::note_relaxed);
    connect(m_start, &StartPage::weave_wanted, this, [this] {
        PresetDialog dialog(this);
        if (dialog.exec() != QDialog::Accepted) return;
        Design design;
        design.root = dialog.preset().family;
        design.blocks[design.root] = std::make_shared<const Node>(Node{PresetLeaf{dialog.preset()}, {}});
        show_design(std::move(design), {}, true);
    });
}

void MainWindow::make_docks() {
    const auto dock = [&](const QString& name, const QString& title, QWidget* widget, Qt::DockWidgetArea area) {
        auto* made = new QDockWidget(title, this);
        made->setObjectName(name);
        auto* scroll = new QScrollArea;  // what is tall must not make the window taller than a laptop's screen
        scroll->setFrameShape(QFrame::NoFrame);
        scroll->setWidgetResizable(true);
        scroll->setFocusPolicy(Qt::NoFocus);  // a click beside a field leaves the keys where they are
        scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
        scroll->setMinimumWidth(widget->minimumSizeHint().width());
        scroll->setWidget(widget);
        made->setWidget(scroll);
        addDockWidget(area, made);
        return made;
    };
    auto* blocks = dock("blocks-dock", tr("Blocks"), m_tree, Qt::LeftDockWidgetArea);
    auto* simulation = dock("simulation-dock", tr("Simulation"), m_simulation, Qt::RightDockWidgetArea);
    auto* yarns = dock("yarns-dock", tr("Yarns"), m_yarns, Qt::RightDockWidgetArea);
    m_tutorial_dock = dock("tutorial-dock", tr("Tutorial"), m_tutorial, Qt::LeftDockWidgetArea);
    auto* submit = dock("submit-dock", tr("Submit"), m_submit, Qt::RightDockWidgetArea);
    tabifyDockWidget(simulation, yarns);
    tabifyDockWidget(yarns, submit);
    connect(m_submit, &SubmitPanel::simulation_wanted, simulation, [simulation] { simulation->raise(); });
    simulation->raise();
    auto* findings = dock("findings-dock", tr("Findings"), m_findings, Qt::BottomDockWidgetArea);
    const int em = fontMetrics().height();
    resizeDocks({findings}, {11 * em}, Qt::Vertical);
    resizeDocks({blocks, simulation}, {16 * em, 24 * em}, Qt::Horizontal);
    m_simulation_dock = simulation;
    setCorner(Qt::BottomLeftCorner, Qt::LeftDockWidgetArea);
    setCorner(Qt::BottomRightCorner, Qt::RightDockWidgetArea);
    connect(m_findings, &FindingsPanel::place_wanted, this, &MainWindow::show_yarns);
    for (QWidget* list : std::initializer_list<QWidget*>{m_findings, m_simulation->findings()})
        new QShortcut(Qt::Key_Escape, list, m_viewer->viewport(), &Viewport::let_go, Qt::WidgetWithChildrenShortcut);
    connect(m_submit, &SubmitPanel::findings_wanted, findings, [findings] {
        findings->show();
        findings->raise();
    });
    connect(m_findings, &FindingsPanel::counted, findings, [findings](std::size_t errors, std::size_t warnings) {
        findings->setWindowTitle(errors + warnings == 0 ? tr("Findings") : tr("Findings (%1)").arg(errors + warnings));
    });
    connect(m_tree, &DesignTree::menu_wanted, this, [this](const QString& block, const QPoint& where) {
        if (m_blocks == nullptr) return;
        QMenu menu;
        m_blocks->fill_menu(menu, block.toStdString());
        menu.exec(where);
    });
    connect(m_tree, &DesignTree::dropped, this, [this](const QString& block, const QString& onto, const QPoint& where) {
        if (m_blocks != nullptr) m_blocks->ask_where_to_attach(onto.toStdString(), block.toStdString(), where);
    });
    connect(m_tree, &DesignTree::renamed, this, [this](const QString& from, const QString& to) {
        if (m_blocks != nullptr) m_blocks->rename(from.toStdString(), to.toStdString());
    });
}

/// Shows a pick, an end, or their crossing, of the cloth: on the card, and among its yarns.
void MainWindow::show_yarns(std::optional<std::size_t> pick, std::optional<std::size_t> end) {
    if (!m_document) return;
    m_document->focus().show_block(m_document->design().root);
    m_document->focus().go_to({pick.value_or(0), end.value_or(0)});
    m_editors->setCurrentWidget(m_card);
    m_viewer_desk->point_out(pick, end);
}

void MainWindow::flip_at_once(const CardPlace& place) {
    m_document->focus().go_to(place);
    const auto step = flip_crossing(*m_document, place);
    if (!step) return tell(QString::fromStdString(step.error().text()));
    if (Status made = m_document->perform(*step); !made) tell_refusal(QString::fromStdString(made.error().text()));
}

/// Offers two yarns that cross to change sides, or says why they cannot.
void MainWindow::flip(const CardPlace& place) {
    m_document->focus().go_to(place);
    const auto step = flip_crossing(*m_document, place);
    m_viewer_desk->point_out(place.pick, place.end);  // so that it is seen which crossing the menu is about
    QMenu menu;
    if (step) {
        menu.addAction(step->text, this, [&] {
            if (m_viewer->mode() == ViewerPanel::Mode::relaxed && m_simulation_desk->flip(place)) return;
            if (Status made = m_document->perform(*step); !made) tell_refusal(QString::fromStdString(made.error().text()));
        });
    } else {
        menu.addAction(QString::fromStdString(step.error().text()))->setEnabled(false);
    }
    menu.exec(QCursor::pos());
    m_viewer->viewport()->let_go();
}

// ---- Documents ----

void MainWindow::show_start_page() {
    m_start->list_recent();
    if (m_pages->currentWidget() == m_work) m_places = saveState(places_version);
    m_pages->setCurrentWidget(m_start);
    for (QDockWidget* dock : findChildren<QDockWidget*>()) dock->hide();
    m_tool_bar->hide();
    show_title();
    show_undo();
}

/// Where its docks were last; what nobody has placed yet, or nobody can read, stands where make_docks() puts it.
void MainWindow::show_workspace() {
    if (m_pages->currentWidget() != m_work) {
        m_pages->setCurrentWidget(m_work);
        if (!restoreState(m_places, places_version)) {
            for (QDockWidget* dock : findChildren<QDockWidget*>()) dock->show();
            m_simulation_dock->raise();
        }
        m_tool_bar->show();
    }
    m_tutorial_dock->setVisible(m_is_learning);
}

void MainWindow::keep_places() {
    if (m_pages->currentWidget() == m_work) m_places = saveState(places_version);
    QSettings settings;
    settings.setValue("window", saveGeometry());
    settings.setValue("work", m_work->saveState());
    settings.setValue("places", m_places);
}

/// For the list of recent designs: how it is looked at, and its picture where that is of what its file holds.
void MainWindow::keep_looks() {
    const QString path = m_document->path();
    if (path.isEmpty()) return;
    if (const Json view = m_viewer_desk->view(); !view.empty()) recent_designs::keep_view(path, view);
    const QImage picture = m_document->thumbnail_of(m_document->design().root);
    if (m_document->is_modified() || picture.isNull()) return;
    in_background(
        this, [path, picture] { recent_designs::keep_picture(path, picture); return true; },
        [this](bool) {
            if (m_pages->currentWidget() == m_start) m_start->list_recent();
        });
}

void MainWindow::close_document() {
    if (!m_document) return;
    keep_looks();
    show_in_parts(nullptr);
    m_messages->clear();  // what it says is of this design
    m_is_learning = false;  // it leads through its own design
    m_blocks = nullptr;
    m_document->discard();
    m_document.reset();
}

void MainWindow::take(std::unique_ptr<Document> document) {
    close_document();
    m_document = std::move(document);
    m_blocks = new BlockActions(*m_document, this);
    connect(m_blocks, &BlockActions::failed, this, &MainWindow::tell_refusal);
    connect(m_blocks, &BlockActions::told, this, &MainWindow::tell);
    connect(m_blocks, &BlockActions::stencil_begun, this, [this] { m_editors->setCurrentWidget(m_stencil); });
    connect(m_blocks, &BlockActions::drawing_begun, this, [this] { m_editors->setCurrentWidget(m_slice); });
    connect(m_blocks, &BlockActions::noted, this, [this](const QString& words) { m_messages->tell(MessageBar::Kind::note, words); });
    follow_document();
    show_in_parts(m_document.get());
    show_workspace();
    show_title();
    show_undo();
}

void MainWindow::follow_document() {
    Document* document = m_document.get();
    connect(document, &Document::edited, this, &MainWindow::show_title);
    connect(document, &Document::edited, this, &MainWindow::forget_refusal);
    connect(&document->undo_stack(), &QUndoStack::indexChanged, this, &MainWindow::show_undo);
    connect(document, &Document::path_changed, this, &MainWindow::show_title);
    connect(document, &Document::modified_changed, this, &MainWindow::show_title);
    connect(&document->keeper(), &Keeper::saved, this, [this, document](const QString& path) {
        tell(tr("Saved as %1").arg(path));
        recent_designs::note(path);
        if (m_document.get() == document) keep_looks();
    });
    connect(&document->keeper(), &Keeper::not_saved, this, [this](const QString& path, const QString& reason) { warn(tr("%1 was not saved: %2").arg(path, reason)); });
    connect(&document->keeper(), &Keeper::changed_outside, this, [this, document](const QString& path) {
        if (m_document.get() == document) ask_to_save_over(path);
    });
    connect(&document->keeper(), &Keeper::kept_again, this, [this] { tell(tr("Unsaved work is kept on the disk again")); });
    connect(&document->keeper(), &Keeper::trouble, this, [this](const QString& reason) { warn(tr("Unsaved work is not safe: %1").arg(reason)); });
}

void MainWindow::show_design(Design design, const QString& path, bool is_saved) {
    m_messages->hide();
    take(std::make_unique<Document>(std::move(design), path, is_saved));
}

void MainWindow::recover(std::unique_ptr<Document> left) {
    take(std::move(left));
    const int steps = m_document->undo_stack().index();
    const QString design = steps == 0 ? tr("The studio was ended before this design was saved. The design is here again.")
                                      : tr("The studio was ended before this design was saved. The design is here again, with its last %n step(s); undo takes them back.", nullptr, steps);
    m_messages->tell(MessageBar::Kind::note, tr("%1 Relaxed yarns are not kept: Run makes them anew.").arg(design));
}

void MainWindow::tell_set_aside(const QStringList& folders) {
    QStringList words{m_messages->words(), tr("Unsaved work could not be read, or not to its end. As it was found it lies in:")};
    words.removeAll(QString());
    m_messages->tell(MessageBar::Kind::warning, (words + folders).join('\n'));
}

void MainWindow::open_file(const QString& path) {
    m_files->open_file(path);
}

/// What was asked for waits until the person has answered what stands open: that may be about the design that is here.
template <class Deed>
void MainWindow::when_answered(Deed deed) {
    if (QApplication::activeModalWidget() == nullptr && QApplication::activePopupWidget() == nullptr) return deed();
    constexpr int a_moment = 100;  // milliseconds
    QTimer::singleShot(a_moment, this, [=, this] { when_answered(deed); });
}

void MainWindow::offer_stencil(const ColouredPicture& picture, const QString& path) {
    when_answered([=, this] {
        const std::vector<std::string> weaves = ask_weaves(picture, path, this);
        if (!weaves.empty()) m_files->make_stencil(picture, weaves, path);
    });
}

void MainWindow::opened(const Design& design, const QString& path, const QStringList& warnings) {
    when_answered([=, this] { take_opened(design, path, warnings); });
}

void MainWindow::take_opened(const Design& design, const QString& path, const QStringList& warnings) {
    if (!may_close()) return tell({});
    show_design(design, path, !path.isEmpty());
    if (!path.isEmpty()) m_viewer_desk->show_view(recent_designs::view(path));
    if (!warnings.isEmpty()) m_messages->tell(MessageBar::Kind::note, warnings.join('\n'));
    if (path.isEmpty()) m_blocks->look_for_layers(m_document->design().root);
    tell(path.isEmpty() ? tr("Imported; save it as a design to keep it") : tr("Opened %1").arg(path));
}

void MainWindow::show_sample(const QString& name) {
    const Sample* sample = find_sample(name.toStdString());
    if (sample == nullptr || !may_close()) return;
    show_design(sample->make(), {}, true);
}

bool MainWindow::may_close() {
    for (;;) {
        wait_for_saving();
        if (!m_document || !m_document->is_modified()) return true;
        QMessageBox box(QMessageBox::Question, tr("Save the design?"), tr("%1 has changes that are not saved.").arg(m_document->name()), QMessageBox::NoButton, this);
        box.setTextFormat(Qt::PlainText);
        auto* save = box.addButton(tr("Save"), QMessageBox::AcceptRole);
        auto* drop = box.addButton(tr("Close without saving"), QMessageBox::DestructiveRole);
        box.addButton(tr("Stay"), QMessageBox::RejectRole);
        box.setDefaultButton(save);
        box.exec();
        if (box.clickedButton() == drop) return true;
        if (box.clickedButton() != save || !m_document || !m_files->save(*m_document)) return false;
    }
}

/// The window lives on meanwhile: a share may take its time.
void MainWindow::wait_for_saving() {
    if (!m_document || !m_document->is_saving()) return;
    tell(tr("Saving %1 …").arg(m_document->name()));
    while (m_document && m_document->is_saving()) QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
}

void MainWindow::ask_to_save_over(const QString& path) {
    QMessageBox box(QMessageBox::Warning, tr("Save over another's changes?"), tr("%1 was changed by another program or window since it was opened or saved here.").arg(path), QMessageBox::NoButton, this);
    box.setTextFormat(Qt::PlainText);
    box.setInformativeText(tr("To save over it loses what was changed there."));
    auto* over = box.addButton(tr("Save over it"), QMessageBox::DestructiveRole);
    auto* other = box.addButton(tr("Save under another name …"), QMessageBox::AcceptRole);
    box.addButton(tr("Do not save"), QMessageBox::RejectRole);
    box.setDefaultButton(other);
    box.exec();
    if (!m_document) return;
    if (box.clickedButton() == over) m_document->save(path, Keeper::Overwrite::anything);
    if (box.clickedButton() == other) m_files->save_as(*m_document);
}

void MainWindow::closeEvent(QCloseEvent* event) {
    if (!may_close()) return event->ignore();
    keep_places();
    close_document();
    event->accept();
}

// ---- Learning ----

void MainWindow::begin_tutorial() {
    if (!may_close()) return;
    Design design;
    design.title = tr("My first pocket").toStdString();
    design.root = "layer";
    design.blocks["layer"] = std::make_shared<const Node>(Node{PresetLeaf{{"plain", {}}}, {}});
    show_design(std::move(design), {}, true);
    m_is_learning = true;
    m_tutorial_dock->show();
    m_tutorial->begin();
    const int width = m_tutorial_dock->width();  // its longest step is to be read without scrolling
    resizeDocks({m_tutorial_dock}, {m_tutorial->height_for(width) + 3 * fontMetrics().height()}, Qt::Vertical);
}

void MainWindow::show_help(const QString& heading) {
    if (m_help == nullptr) m_help = new HelpWindow(this);
    m_help->show();
    m_help->raise();
    m_help->show_heading(heading);
}

/// Rings what a step of the tutorial needs, for two seconds.
void MainWindow::show_where(std::size_t step) {
    QWidget* const repeat = m_tool_bar->widgetForAction(m_repeat);
    QWidget* const run = m_tool_bar->widgetForAction(m_simulation->run_action());
    const std::array<QWidget*, Tutorial::steps> places{repeat, run, m_card, m_viewer, m_simulation->scene()};
    if (step >= places.size()) return;
    if (places[step] == m_card) m_editors->setCurrentWidget(m_card);
    for (QWidget* above = places[step]; above != nullptr; above = above->parentWidget()) {
        if (auto* dock = qobject_cast<QDockWidget*>(above)) dock->show(), dock->raise();
        if (auto* tabs = qobject_cast<QTabWidget*>(above->parentWidget() ? above->parentWidget()->parentWidget() : nullptr)) tabs->setCurrentWidget(above);
    }
    auto* ring = new QRubberBand(QRubberBand::Rectangle, this);
    ring->setGeometry(QRect(places[step]->mapTo(this, QPoint()), places[step]->size()));
    ring->show();
    QTimer::singleShot(2000, ring, &QObject::deleteLater);
}

// ---- What is told ----

void MainWindow::show_title() {
    if (!m_document) return setWindowTitle(tr("Weave studio"));
    setWindowTitle(tr("%1[*] — Weave studio").arg(m_document->name()));
    setWindowModified(m_document->is_modified());
    setWindowFilePath(m_document->path());
}

void MainWindow::show_undo() {
    for (QAction* action : m_design_actions) action->setEnabled(m_document != nullptr);
    if (m_undo == nullptr) return;
    const QUndoStack* stack = m_document ? &m_document->undo_stack() : nullptr;
    m_undo->setEnabled(stack != nullptr && stack->canUndo());
    m_redo->setEnabled(stack != nullptr && stack->canRedo());
    m_undo->setText(m_undo->isEnabled() ? tr("Undo: %1").arg(stack->undoText()) : tr("Undo"));
    m_redo->setText(m_redo->isEnabled() ? tr("Redo: %1").arg(stack->redoText()) : tr("Redo"));
}

/// What is told of the step itself holds no longer.
void MainWindow::undo() {
    const QString step = m_document->undo_stack().undoText();
    m_document->undo();
    tell(tr("Undone: %1").arg(step));
}

void MainWindow::redo() {
    const QString step = m_document->undo_stack().redoText();
    m_document->redo();
    tell(tr("Done again: %1").arg(step));
}

void MainWindow::tell(const QString& words) {
    m_status->setText(words);
}

void MainWindow::warn(const QString& reason) {
    m_messages->tell(MessageBar::Kind::error, reason);
}

/// An edit that was not made: said until one is.
void MainWindow::tell_refusal(const QString& reason) {
    m_refusal = reason;
    warn(reason);
}

void MainWindow::forget_refusal() {
    if (!m_refusal.isEmpty() && m_messages->words() == m_refusal) m_messages->clear();
    m_refusal.clear();
}

std::string MainWindow::chosen_block() const {
    const std::string chosen = m_tree->chosen();
    return chosen.empty() && m_document ? m_document->shown_block() : chosen;
}

/// A key that the focused field or button would take for itself, such as Space on a button, is no shortcut of the window there.
bool MainWindow::eventFilter(QObject* watched, QEvent* event) {
    if (event->type() == QEvent::ShortcutOverride) {
        const auto* key = static_cast<QKeyEvent*>(event);
        const bool presses = qobject_cast<QAbstractButton*>(watched) != nullptr || qobject_cast<QComboBox*>(watched) != nullptr;
        if (presses && key->key() == Qt::Key_Space && key->modifiers() == Qt::NoModifier) {
            event->accept();
            return true;
        }
    }
    return QMainWindow::eventFilter(watched, event);
}

}  // namespace weave::studio
