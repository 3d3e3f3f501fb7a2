#pragma once

#include <weave/block/block_grid.hpp>
#include <weave/design/design.hpp>

#include <QWidget>

#include <cstddef>
#include <memory>
#include <studio/jobs/happenings.hpp>
#include <studio/jobs/state_words.hpp>

class QAction;
class QLabel;
class QProgressBar;
class QSpinBox;
class QTabWidget;

namespace weave::studio {

class BackendRow;
class FidelityGroup;
class MessageBar;
class RegionGroup;
class ResidualPlot;
class SceneGroup;
class SimulationDriver;
class SimulationFindings;
class SystemGroup;
class YarnsFiles;

/// Runs the simulation of a design and shows how it goes. It does not own the design: what is changed here is
/// told by scene_edited(), and what became of it comes back by set_design().
class SimulationPanel : public QWidget {
    Q_OBJECT
  public:
    explicit SimulationPanel(QWidget* parent = nullptr);
    ~SimulationPanel() override;

    /// The design as it is now; a run goes on with it as far as changes can be led in, else it is marked as
    /// out of date.
    void set_design(const Design& design);
    /// No design is shown, or another one: the run ends, and nothing of it is told from here on.
    void clear_design();
    /// The design has become another cloth: the run and its yarns go, and their memory with them.
    void let_go();
    /// Rows and columns of stacks of its cloth, for the part that is simulated.
    void set_cloth(const BlockGrid& grid);
    /// Leads a crossing of the running simulation to its other side.
    void flip(const Flip& flip);

    /// Actions for a menu; Space toggles run and pause while this panel has the focus, or in the window that
    /// adds the action.
    [[nodiscard]] QAction* run_action() const { return m_run_action; }
    [[nodiscard]] QAction* step_action() const { return m_step_action; }
    [[nodiscard]] QAction* stop_action() const { return m_stop_action; }
    [[nodiscard]] QAction* again_action() const { return m_again_action; }
    [[nodiscard]] QAction* save_action() const { return m_save_action; }
    [[nodiscard]] QAction* open_action() const { return m_open_action; }

    [[nodiscard]] const RunState& state() const;
    [[nodiscard]] bool is_out_of_date() const { return m_is_out_of_date; }
    /// Where the run computes, in words; as it was chosen when it began.
    [[nodiscard]] const QString& machine() const { return m_machine; }
    /// Without asking for a name: .yarns, .vtp or .obj.
    void save_to(const QString& file);
    void open(const QString& file);

    // The parts, by which tests and screenshots reach them.
    [[nodiscard]] SystemGroup* warp() const { return m_warp; }
    [[nodiscard]] SystemGroup* weft() const { return m_weft; }
    [[nodiscard]] SceneGroup* scene() const { return m_scene; }
    [[nodiscard]] RegionGroup* region() const { return m_region; }
    [[nodiscard]] FidelityGroup* fidelity() const { return m_fidelity; }
    [[nodiscard]] BackendRow* backend() const { return m_backend; }
    [[nodiscard]] ResidualPlot* plot() const { return m_plot; }
    [[nodiscard]] SimulationFindings* findings() const { return m_findings; }
    [[nodiscard]] MessageBar* message_bar() const { return m_message; }
    [[nodiscard]] QLabel* sentence() const { return m_sentence; }
    [[nodiscard]] QTabWidget* tabs() const { return m_tabs; }

  Q_SIGNALS:
    /// The scene of the design as it is to be. While a slider is held the edits are one for the undo list.
    void scene_edited(const weave::Scene& scene, bool is_dragging);
    /// Somebody wants to look there; pick and end from 0.
    void place_wanted(std::size_t pick, std::size_t end);

    // For a view of the yarns, as Relaxation has them.
    /// A run begins, or there is none any more.
    void begun();
    /// Whether what is shown is of the design before a change.
    void dated_changed(bool is_dated);
    void phase_changed(weave::studio::RunPhase phase);
    void laid_out(const std::shared_ptr<const weave::studio::YarnLayout>& layout);
    void frame_came(const std::shared_ptr<const weave::studio::Frame>& frame);
    /// At rest, paused or from a file: for colours by strain, contact and displacement.
    void yarns_came(const std::shared_ptr<const weave::Yarns>& yarns);
    /// What the run of this design came to, as yarns_came() told; a file is none.
    void run_stood(const std::shared_ptr<const weave::Yarns>& yarns);
    /// One that is done belongs into the design (PutFlip).
    void flip_ended(const weave::Flip& flip, bool done, const QString& reason);

  protected:
    bool eventFilter(QObject* watched, QEvent* event) override;
    void changeEvent(QEvent* event) override;

  private:
    void make_actions();
    QWidget* make_controls();
    QWidget* make_result_page();
    QWidget* make_yarns_page();
    QWidget* make_cloth_page();
    void connect_parts();
    void connect_driver();
    void guard_keys();

    [[nodiscard]] bool begin();
    [[nodiscard]] bool begins_anew() const;
    void forget_run();
    void set_out_of_date(bool is_dated);
    void toggle_run();
    void step();
    void start_again();
    void edit_scene(bool is_dragging);
    void compare_choices();
    void ask_to_save();
    void ask_to_open();
    void show_state();
    void show_actions();
    void show_icons();
    void show_progress();
    void show_findings();
    void show_file(const std::shared_ptr<const Yarns>& yarns,
                   const std::shared_ptr<const Inspection>& inspection);

    Design m_design;
    bool m_has_design = false, m_is_out_of_date = false, m_choices_differ = false;
    QString m_machine;
    RunPhase m_shown_phase = RunPhase::idle;
    std::shared_ptr<const Yarns> m_yarns;  ///< that can be saved
    std::shared_ptr<const Inspection> m_shown_inspection;
    SimulationDriver* m_driver;
    YarnsFiles* m_files;
    QAction *m_run_action, *m_step_action, *m_stop_action, *m_again_action, *m_save_action, *m_open_action;
    MessageBar* m_message;
    BackendRow* m_backend;
    FidelityGroup* m_fidelity;
    QSpinBox* m_steps;
    QLabel *m_sentence, *m_out_of_date;
    QProgressBar* m_progress;
    QTabWidget* m_tabs;
    ResidualPlot* m_plot;
    SimulationFindings* m_findings;
    SystemGroup *m_warp, *m_weft;
    SceneGroup* m_scene;
    RegionGroup* m_region;
};

}  // namespace weave::studio
