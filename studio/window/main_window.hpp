#pragma once

#include <QMainWindow>

#include <memory>
#include <studio/document/document.hpp>

class QAction;
class QDockWidget;
class QLabel;
class QMenu;
class QSplitter;
class QStackedWidget;
class QTabWidget;
class QToolBar;

namespace weave::studio {

class BlockActions;
class CardEditor;
struct ColouredPicture;
class DesignFiles;
class DesignTree;
class FindingsPanel;
class HelpWindow;
class MessageBar;
class SliceDesk;
class SliceEditor;
class StartPage;
class StencilDesk;
class StencilEditor;
class SimulationDesk;
class SimulationPanel;
class SubmitDesk;
class SubmitPanel;
class Tutorial;
class ViewerDesk;
class ViewerPanel;
class YarnsPanel;

/// The window of one design: the start page until there is one, then its editors and panels. It owns the document; all else looks
/// at it.
class MainWindow : public QMainWindow {
    Q_OBJECT
  public:
    explicit MainWindow(QWidget* parent = nullptr);
    ~MainWindow() override;

    /// The document of this window; null while it shows the start page.
    [[nodiscard]] Document* document() { return m_document.get(); }
    /// From now on this design; what was here is closed without a question.
    void show_design(Design design, const QString& path, bool is_saved);
    /// Goes on where a program was ended, with what it left.
    void recover(std::unique_ptr<Document> left);
    /// Says something in passing.
    void tell(const QString& words);
    /// Says what went wrong, until it is closed or something else is said.
    void warn(const QString& reason);
    /// Tells where unsaved work lies that could not be read.
    void tell_set_aside(const QStringList& folders);
    void open_file(const QString& path);
    /// Opens a sample as a new design.
    void show_sample(const QString& name);
    /// Asks whether to save what would be lost; false: the person wants to stay.
    bool may_close();

  Q_SIGNALS:
    /// A file that was asked for is none that can be opened; the window says so too.
    void not_opened(const QString& reason);

  protected:
    void closeEvent(QCloseEvent* event) override;
    bool eventFilter(QObject* watched, QEvent* event) override;

  private:
    void make_workspace();
    void make_docks();
    void make_menus();
    void make_file_menu();
    void make_edit_menu();
    void make_view_menu();
    void make_simulation_menu();
    void make_help_menu();
    void make_tool_bar();
    void take(std::unique_ptr<Document> document);
    void close_document();
    void show_in_parts(Document* document);
    void show_start_page();
    void show_workspace();
    void keep_places();
    void keep_looks();
    void begin_tutorial();
    void show_help(const QString& heading);
    void show_where(std::size_t step);
    void follow_document();
    void show_title();
    void show_undo();
    void undo();
    void redo();
    void tell_refusal(const QString& reason);
    void forget_refusal();
    void flip(const CardPlace& place);
    void show_yarns(std::optional<std::size_t> pick, std::optional<std::size_t> end);
    void flip_at_once(const CardPlace& place);
    void wait_for_saving();
    void ask_to_save_over(const QString& path);
    void opened(const Design& design, const QString& path, const QStringList& warnings);
    void take_opened(const Design& design, const QString& path, const QStringList& warnings);
    void offer_stencil(const ColouredPicture& picture, const QString& path);
    template <class Deed>
    void when_answered(Deed deed);
    QAction* add(QMenu& menu, const QString& text, const QKeySequence& keys, std::function<void()> deed, bool needs_design = true);
    [[nodiscard]] std::string chosen_block() const;

    std::unique_ptr<Document> m_document;
    DesignFiles* m_files;
    BlockActions* m_blocks = nullptr;  ///< of the document
    QStackedWidget* m_pages;
    QSplitter* m_work;
    StartPage* m_start;
    QTabWidget* m_editors;
    CardEditor* m_card;
    SliceEditor* m_slice;
    SliceDesk* m_slice_desk;
    StencilEditor* m_stencil;
    StencilDesk* m_stencil_desk;
    ViewerPanel* m_viewer;
    ViewerDesk* m_viewer_desk;
    DesignTree* m_tree;
    FindingsPanel* m_findings;
    SimulationPanel* m_simulation;
    SimulationDesk* m_simulation_desk;
    YarnsPanel* m_yarns;
    SubmitPanel* m_submit;
    SubmitDesk* m_submit_desk;
    Tutorial* m_tutorial;
    QDockWidget* m_tutorial_dock = nullptr;
    QDockWidget* m_simulation_dock = nullptr;
    HelpWindow* m_help = nullptr;  ///< once it was asked for
    bool m_is_learning = false;
    QString m_refusal;  ///< of an edit, while it may be told
    MessageBar* m_messages;
    QLabel* m_status;
    QAction* m_undo = nullptr;
    QAction* m_redo = nullptr;
    QList<QAction*> m_design_actions;  ///< that need a design
    QAction* m_repeat = nullptr;
    QList<QAction*> m_tools;           ///< of these the ones in the tool bar
    QByteArray m_places;               ///< of docks, while the start page is shown
    QToolBar* m_tool_bar = nullptr;
};

}  // namespace weave::studio
