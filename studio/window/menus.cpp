// The menus of the main window.

#include <studio/window/main_window.hpp>

#include <QActionGroup>
#include <QApplication>
#include <QDockWidget>
#include <QMenuBar>
#include <QMessageBox>
#include <QSettings>
#include <QToolBar>

#include <algorithm>
#include <array>
#include <functional>
#include <studio/editors/card_editor.hpp>
#include <studio/editors/slice_editor.hpp>
#include <studio/editors/stencil_editor.hpp>
#include <studio/panels/simulation_panel.hpp>
#include <studio/viewport/viewer_panel.hpp>
#include <studio/window/block_actions.hpp>
#include <studio/window/design_files.hpp>
#include <studio/window/recent_designs.hpp>

namespace weave::studio {

QAction* MainWindow::add(QMenu& menu, const QString& text, const QKeySequence& keys, std::function<void()> deed, bool needs_design) {
    QAction* action = menu.addAction(text, this, std::move(deed));
    action->setShortcut(keys);
    if (needs_design) m_design_actions.push_back(action);
    return action;
}

void MainWindow::make_menus() {
    make_file_menu();
    make_edit_menu();
    make_view_menu();
    make_simulation_menu();
    make_help_menu();
    make_tool_bar();
}

void MainWindow::make_file_menu() {
    QMenu& menu = *menuBar()->addMenu(tr("&File"));
    add(menu, tr("&New"), QKeySequence::New, [this] {
        if (!may_close()) return;
        close_document();
        show_start_page();
    }, false);
    add(menu, tr("&Open …"), QKeySequence::Open, [this] { m_files->open(); }, false);
    QMenu* recent = menu.addMenu(tr("Open &recent"));
    connect(recent, &QMenu::aboutToShow, this, [this, recent] {
        recent->clear();
        for (const QString& path : recent_designs::paths()) recent->addAction(path, this, [this, path] { open_file(path); });
        if (recent->isEmpty()) recent->addAction(tr("none yet"))->setEnabled(false);
    });
    menu.addSeparator();
    add(menu, tr("&Save"), QKeySequence::Save, [this] { m_files->save(*m_document); });
    add(menu, tr("Save &as …"), QKeySequence::SaveAs, [this] { m_files->save_as(*m_document); });
    add(menu, tr("&Export the card image …"), QKeySequence(tr("Ctrl+E")), [this] { m_files->export_card(*m_document); });
    menu.addSeparator();
    add(menu, tr("&Close the window"), QKeySequence::Close, [this] { close(); }, false);
    add(menu, tr("&Quit"), QKeySequence::Quit, [] { QApplication::closeAllWindows(); }, false);
}

void MainWindow::make_edit_menu() {
    QMenu& menu = *menuBar()->addMenu(tr("&Edit"));
    m_undo = add(menu, tr("Undo"), QKeySequence::Undo, [this] { undo(); }, false);
    m_redo = add(menu, tr("Redo"), QKeySequence(tr("Ctrl+Shift+Z")), [this] { redo(); }, false);
    menu.addSeparator();
    add(menu, tr("Copy block"), QKeySequence::Copy, [this] { m_blocks->copy(chosen_block()); });
    add(menu, tr("Cut block"), QKeySequence::Cut, [this] {
        m_blocks->copy(chosen_block());
        m_blocks->remove(chosen_block());
    });
    add(menu, tr("Paste block"), QKeySequence::Paste, [this] { m_blocks->paste(); });
    add(menu, tr("Duplicate block"), QKeySequence(tr("Ctrl+D")), [this] { m_blocks->duplicate(chosen_block()); });
    menu.addSeparator();
    QMenu& block = *menuBar()->addMenu(tr("&Block"));
    m_tools.push_back(add(block, tr("Add a traditional &weave …"), {}, [this] { m_blocks->add_weave(); }));
    m_tools.push_back(add(block, tr("Add a &drawing (slice)"), {}, [this] { m_blocks->add_drawing(); }));
    m_tools.push_back(add(block, tr("&Stencil from the block shown"), {}, [this] { m_blocks->add_stencil(); }));
    m_repeat = add(block, tr("&Repeat the block shown …"), {}, [this] { m_blocks->repeat(m_document->shown_block()); });
    m_tools.push_back(m_repeat);
    QAction* attach = add(block, tr("&Attach to the block shown"), {}, [] {});
    attach->setCheckable(true);
    attach->setToolTip(tr("Choose in the 3D view the side of the block to which another is attached"));
    m_tools.push_back(attach);
    if (Viewport* viewport = m_viewer->viewport()) {
        connect(attach, &QAction::toggled, this, [this, viewport](bool on) {
            if (on) m_viewer->set_mode(ViewerPanel::Mode::planned);
            viewport->set_attach_mode(on);
        });
        connect(viewport, &Viewport::attach_mode_changed, attach, &QAction::setChecked);
    }
    block.addSeparator();
    QMenu* chosen = block.addMenu(tr("The &chosen block"));
    m_design_actions.push_back(chosen->menuAction());
    connect(chosen, &QMenu::aboutToShow, this, [this, chosen] {
        chosen->clear();
        if (m_blocks != nullptr) m_blocks->fill_menu(*chosen, chosen_block());
    });
}

void MainWindow::make_view_menu() {
    QMenu& menu = *menuBar()->addMenu(tr("&View"));
    // One key for the editor in which the person is: the viewer has its own.
    const auto in_sight = [this](auto viewer, auto canvas) {
        return [this, viewer, canvas] {
            Viewport* viewport = m_viewer->viewport();
            if (viewport != nullptr && viewport->hasFocus()) return viewer(*viewport);
            if (m_stencil->isVisible()) return canvas(m_stencil->canvas());
            if (m_slice->isVisible()) return canvas(m_slice->canvas_in_sight());
            canvas(m_card->canvas());
        };
    };
    add(menu, tr("&Larger"), QKeySequence("+"), in_sight([](Viewport& view) { view.zoom(1.25); }, [](auto& canvas) { canvas.zoom_in(); }));
    add(menu, tr("&Smaller"), QKeySequence("-"), in_sight([](Viewport& view) { view.zoom(0.8); }, [](auto& canvas) { canvas.zoom_out(); }));
    add(menu, tr("&Fit"), QKeySequence("F"), in_sight([](Viewport& view) { view.fit(); }, [](auto& canvas) { canvas.fit(); }));
    menu.addSeparator();
    const std::vector<std::pair<StandardView, QString>> views{{StandardView::face, tr("Face")}, {StandardView::back, tr("Back")},
                                                              {StandardView::warp_side, tr("Along the picks (warp side)")}, {StandardView::weft_side, tr("Along the ends (weft side)")},
                                                              {StandardView::corner, tr("Corner")}, {StandardView::opposite_corner, tr("Opposite corner")}};
    for (std::size_t k = 0; k < views.size(); ++k)
        add(menu, views[k].second, QKeySequence(QString::number(k + 1)), [this, view = views[k].first] {
            if (m_viewer->viewport() != nullptr) m_viewer->viewport()->turn_to(view);
        });
    menu.addSeparator();
    for (QAction* action : m_viewer->menu_actions()) {
        menu.addAction(action);
        m_design_actions.push_back(action);
    }
    menu.addSeparator();
    QMenu* corners = menu.addMenu(tr("Corner of &pick 1 and end 1"));
    auto* group = new QActionGroup(this);
    const std::array<QString, 4> names{tr("Bottom left"), tr("Bottom right"), tr("Top left"), tr("Top right")};  // as Corner has them
    const auto chosen = std::min<std::size_t>(QSettings().value("corner").toUInt(), names.size() - 1);
    for (std::size_t k = 0; k < names.size(); ++k) {
        QAction* corner = group->addAction(corners->addAction(names[k], this, [this, k] {
            m_card->canvas().set_corner(static_cast<Corner>(k));
            QSettings().setValue("corner", static_cast<unsigned>(k));
        }));
        corner->setCheckable(true);
        corner->setChecked(k == chosen);
    }
    m_card->canvas().set_corner(static_cast<Corner>(chosen));
    menu.addSeparator();
    for (QDockWidget* dock : findChildren<QDockWidget*>()) {
        menu.addAction(dock->toggleViewAction());
        m_design_actions.push_back(dock->toggleViewAction());
    }
}

void MainWindow::make_simulation_menu() {
    QMenu& menu = *menuBar()->addMenu(tr("&Simulation"));
    for (QAction* action : {m_simulation->run_action(), m_simulation->step_action(), m_simulation->stop_action(), m_simulation->again_action()}) menu.addAction(action);
    menu.addSeparator();
    for (QAction* action : {m_simulation->save_action(), m_simulation->open_action()}) menu.addAction(action);
}

/// What a designer reaches for most, in words: nobody has to guess pictures.
void MainWindow::make_tool_bar() {
    QToolBar* bar = addToolBar(tr("Tools"));
    bar->setObjectName("tools");
    bar->setMovable(false);
    bar->setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
    const QStringList names{tr("+ Weave"), tr("+ Drawing"), tr("Stencil"), tr("Repeat"), tr("Attach")};
    for (int k = 0; k < names.size(); ++k) {
        m_tools[k]->setIconText(names[k]);
        bar->addAction(m_tools[k]);
    }
    bar->addSeparator();
    m_undo->setIconText(tr("Undo"));
    m_redo->setIconText(tr("Redo"));
    bar->addActions({m_undo, m_redo});
    bar->addSeparator();
    bar->addAction(m_simulation->run_action());
    m_tool_bar = bar;
}

void MainWindow::make_help_menu() {
    QMenu& menu = *menuBar()->addMenu(tr("&Help"));
    add(menu, tr("&Learn it in five steps"), {}, [this] { begin_tutorial(); }, false);
    add(menu, tr("The designer's &guide"), QKeySequence::HelpContents, [this] { show_help(tr("The designer's guide to the studio")); }, false);
    add(menu, tr("&Keys and mouse"), {}, [this] { show_help(tr("Keys and mouse")); }, false);
    menu.addSeparator();
    add(menu, tr("&About"), {}, [this] {
        QMessageBox::about(this, tr("Weave studio"), tr("Weave studio %1\n3D woven cloth, from the first block to the loom.").arg(QApplication::applicationVersion()));
    }, false);
}

}  // namespace weave::studio
