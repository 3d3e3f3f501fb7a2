#pragma once

#include <studio/viewport/model_maker.hpp>
#include <studio/viewport/viewport.hpp>

#include <QImage>
#include <QList>
#include <QWidget>

#include <array>

class QAction;
class QActionGroup;
class QComboBox;
class QLabel;
class QSlider;
class QSpinBox;
class QStackedWidget;
class QToolBar;
class QToolButton;

namespace weave::studio {

/// The 3D viewer with its tools: planned or relaxed yarns, their colours, repeats, the plane that cuts, views
/// and the lock.
class ViewerPanel : public QWidget {
    Q_OBJECT
  public:
    enum class Mode : std::uint8_t { planned, relaxed };

    /// Without OpenGL (`trouble` says why) the panel says so, and all else works as ever.
    explicit ViewerPanel(QWidget* parent = nullptr, const QString& trouble = found_gl().trouble);

    /// The planned curves of the block that is shown, made into a picture in another thread.
    void set_planned(std::shared_ptr<const Design> design, std::shared_ptr<const ClothCurves> curves);
    /// There is no plan; `why` in a sentence or two, empty: nothing is open.
    void set_no_plan(const QString& why = {});
    /// The relaxed yarns; null: none. The panel does not change its mode by itself.
    void set_relaxed(std::shared_ptr<const Yarns> yarns);
    /// Control points of the relaxed yarns as they lie now, in the yarns' order; they wait while planned
    /// yarns are shown, the newest only. Refused where they are not of these yarns.
    Status set_points(const std::vector<std::vector<Vec3>>& control);

    [[nodiscard]] Mode mode() const { return m_mode; }
    void set_mode(Mode mode);
    [[nodiscard]] ColourBy colour() const { return m_colour; }
    void set_colour(ColourBy colour);
    [[nodiscard]] Viewport* viewport() const { return m_viewport; }
    /// What is written over the yarns while they are shown in this mode; empty: nothing.
    void set_caption(Mode mode, const QString& words);
    /// For a menu: lock, attach, save the picture.
    [[nodiscard]] QList<QAction*> menu_actions() const { return {m_lock, m_attach, m_save}; }

    /// Camera, mode, colours, repeats, cut and lock, to be found again; what it does not know of it leaves as it
    /// is.
    [[nodiscard]] Json state() const;
    Status set_state(const Json& json);

  Q_SIGNALS:
    /// A model that was asked for is shown, or cannot be.
    void model_shown();
    /// A picture of what is seen is to be saved, twice as fine as on a plain display.
    void picture_taken(const QImage& picture);

  private:
    void build_tools();
    void add_looks();
    QWidget* make_pieces();
    void make_repeats();
    void make_clip();
    void add_views();
    void add_rest();
    QAction* add_action(int icon, const QString& text, const QString& tip);
    void make_model();
    void show_model(std::shared_ptr<TubeModel> model);
    void say_empty();
    void show_caption();
    void follow_model();
    void apply_repeat();
    void apply_clip();
    void choose_clip(int axis);
    void set_cut(const Json& cut);

    ModelMaker m_maker;
    QStackedWidget* m_pages = nullptr;
    Viewport* m_viewport = nullptr;
    QToolBar* m_tools = nullptr;
    QWidget* m_pieces = nullptr;  ///< repeats and the cut, in a row of their own that always has room for them
    QComboBox *m_modes = nullptr, *m_colours = nullptr, *m_clips = nullptr;
    QSpinBox *m_along_ends = nullptr, *m_along_picks = nullptr;
    QSlider* m_clip_at = nullptr;
    QToolButton* m_other_side = nullptr;
    QAction *m_lock = nullptr, *m_perspective = nullptr, *m_attach = nullptr,
            *m_save = nullptr;

    std::shared_ptr<const Design> m_design;
    std::shared_ptr<const ClothCurves> m_curves;
    std::shared_ptr<const Yarns> m_yarns;
    std::vector<std::vector<Vec3>> m_points;  ///< of the relaxed yarns, where they have moved since
    Mode m_mode = Mode::planned, m_shown_mode = Mode::planned;
    ColourBy m_colour = ColourBy::yarn;
    double m_clip_side = 1;
    QString m_failure, m_why_no_plan;
    std::array<QString, 2> m_captions;  ///< by mode
};

}  // namespace weave::studio
