#pragma once

#include <studio/viewport/found_gl.hpp>
#include <studio/viewport/orientation_cube.hpp>
#include <studio/viewport/picking.hpp>
#include <studio/viewport/tube_painter.hpp>
#include <studio/viewport/view_history.hpp>
#include <studio/viewport/yarn_canvas.hpp>

#include <QTimer>
#include <QVariantAnimation>
#include <QWidget>

#include <memory>
#include <optional>
#include <vector>

namespace weave::studio {

class Viewport;

/// What is written over the yarns, as a widget of its own: drawn by the processor, which makes smooth lines
/// where OpenGL has none, and without drawing the yarns again.
class OverlaySheet : public QWidget {
    Q_OBJECT
  public:
    explicit OverlaySheet(Viewport& viewport);

  protected:
    void paintEvent(QPaintEvent* event) override;

  private:
    Viewport& m_viewport;
};

/// A pick or an end, by its number from 0.
struct YarnName {
    weave::System system = weave::System::warp;
    std::size_t number = 0;
    friend bool operator==(const YarnName&, const YarnName&) = default;
};

/// Shows a TubeModel, to look at from all sides, and tells what is pointed at.
///
/// Mouse: drag left to turn, middle or Shift and left to move, wheel to zoom at the cursor; a press and
/// release that is no drag is a click. Keys: F all in view, 1 to 6 the standard views, + and − zoom, arrows
/// turn (with Shift: move), Alt+Left and Alt+Right the views before and after, L locks the view, Esc lets go.
class Viewport : public QWidget {
    Q_OBJECT
  public:
    /// `is_software`: whether OpenGL is a program of the processor.
    explicit Viewport(QWidget* parent = nullptr, bool is_software = found_gl().is_software);
    ~Viewport() override;

    /// What is shown from now on; null: nothing. The view stays where it is, unless there was nothing before:
    /// then all is fitted.
    void set_model(std::shared_ptr<TubeModel> model);
    [[nodiscard]] const TubeModel* model() const { return m_model.get(); }
    /// New places of the yarns that are shown, as from a simulation that runs: see TubeModel::update().
    Status update_points(const std::vector<std::vector<Vec3>>& control);
    /// Pieces along the ends and along the picks, 1 to most_repeats each; 1 where the piece is not periodic.
    void set_repeat(std::array<std::size_t, 2> repeat);
    void set_clip(std::optional<Plane> clip);
    [[nodiscard]] const Shown& shown() const { return m_shown; }
    [[nodiscard]] Box shown_box() const;

    /// These stand out and all others are dimmed, in whatever is shown, until the person lets go of them.
    void point_out(std::vector<YarnName> yarns);
    [[nodiscard]] const std::vector<YarnName>& pointed_out() const { return m_pointed_out; }
    /// Of the yarns that stand out, and of the one that was clicked first.
    void let_go();
    /// Faces of the block are offered instead of yarns.
    void set_attach_mode(bool attach);
    [[nodiscard]] bool attach_mode() const { return m_attach; }
    /// How much is shown, such as "rows 1 to 40 of 900".
    void set_caption(const QString& text);
    [[nodiscard]] const QString& caption() const { return m_caption; }
    /// What is said where there is nothing to see, in some words, and why, in one or two sentences.
    void set_empty_words(const QString& title, const QString& text);

    [[nodiscard]] const Camera& camera() const { return m_camera; }
    /// Goes there at once, also where the view is locked, as a document does that is opened.
    void set_camera(const Camera& camera);
    /// These six are ignored while the view is locked.
    void fit();
    void turn_to(StandardView view);
    void zoom(double factor);
    void set_perspective(bool perspective);
    void view_back();
    void view_on();
    void set_locked(bool locked);
    [[nodiscard]] bool is_locked() const { return m_locked; }
    /// Whether views glide to one another, in 150 ms, and pictures in motion may be coarser where the
    /// processor draws them.
    void set_animated(bool animated) { m_animated = animated; }

    /// What is to be seen, with legend, scale and caption, `times` as many pixels across as the widget has on
    /// a plain display.
    QImage picture(int times);
    /// The yarns alone, as they are on the screen.
    QImage yarns_on_screen() { return m_canvas->yarns(); }
    /// Why nothing can be drawn; empty where all is well.
    [[nodiscard]] const QString& trouble() const { return m_trouble; }
    /// The yarn that was clicked first and waits for the one that it crosses.
    [[nodiscard]] std::optional<std::uint32_t> held_yarn() const { return m_held; }
    [[nodiscard]] std::optional<std::uint32_t> hovered_yarn() const { return m_hovered; }
    [[nodiscard]] const OrientationCube& cube() const { return m_cube; }
    [[nodiscard]] QString empty_words() const { return m_empty_title + ": " + m_empty_words; }
    [[nodiscard]] QString hint() const;
    /// What drew the last picture and how; for the status bar and measurements.
    [[nodiscard]] const TubePainter& painter() const { return m_painter; }

    /// Legend, scale, caption and axes; for the screen also what takes the mouse.
    void paint_over(QPainter& painter, const QRectF& area, bool for_screen);

  Q_SIGNALS:
    void yarn_clicked(weave::System system, std::size_t number, weave::Vec3 place);
    /// Counted from 0.
    void crossing_clicked(std::size_t pick, std::size_t end);
    void face_clicked(weave::Face face);
    void camera_changed();
    void locked_changed(bool locked);
    void attach_mode_changed(bool attach);
    void trouble_found(const QString& words);

  protected:
    void mousePressEvent(QMouseEvent* event) override;
    void mouseMoveEvent(QMouseEvent* event) override;
    void mouseReleaseEvent(QMouseEvent* event) override;
    void mouseDoubleClickEvent(QMouseEvent* event) override { mousePressEvent(event); }
    void wheelEvent(QWheelEvent* event) override;
    void keyPressEvent(QKeyEvent* event) override;
    void leaveEvent(QEvent* event) override;
    bool event(QEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

  private:
    enum class Drag : std::uint8_t { none, pressed, orbit, pan };

    [[nodiscard]] PictureSize picture_size() const;
    [[nodiscard]] Ray ray_at(const QPointF& place) const;
    [[nodiscard]] TubeFrame frame_of(double pixel_ratio) const;
    void start();
    void draw(unsigned target);
    void draw_yarns(const TubeFrame& frame, unsigned target);
    void place_cube();
    void look_again();
    void update_states();

    void move_camera(const Camera& camera);
    void glide_to(const Camera& camera);
    void note_view();
    void set_moving();

    void hover(const QPointF& place, const QPoint& global);
    void clear_hover();
    void click(const QPointF& place);
    void click_yarn(const QPointF& place);
    void drag_to(const QPointF& place, Qt::KeyboardModifiers modifiers);
    bool press_key(QKeyEvent* event);
    bool press_move_key(int key, bool shift);

    std::shared_ptr<TubeModel> m_model;
    Shown m_shown;
    TubePainter m_painter;
    std::unique_ptr<YarnCanvas> m_canvas;
    QString m_trouble, m_caption, m_empty_title, m_empty_words;

    Camera m_camera;
    ViewHistory m_history;
    QVariantAnimation m_glide;
    OverlaySheet m_sheet;
    QTimer m_rest, m_settled;
    bool m_is_fitted = false, m_locked = false, m_animated = true, m_moving = false;
    double m_moving_scale = 1;  ///< of the pictures while the camera moves

    OrientationCube m_cube;
    std::optional<Face> m_cube_face, m_block_face;
    bool m_attach = false;
    std::vector<YarnName> m_pointed_out;
    std::optional<std::uint32_t> m_hovered, m_held;
    bool m_missed = false;  ///< the last two yarns clicked do not cross

    Drag m_drag = Drag::none;
    Qt::MouseButton m_button = Qt::NoButton;
    QPointF m_pressed, m_last;
};

}  // namespace weave::studio
