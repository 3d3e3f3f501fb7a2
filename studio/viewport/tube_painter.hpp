#pragma once

#include <studio/viewport/software_finder.hpp>

#include <QOpenGLFunctions_3_3_Core>
#include <QOpenGLShaderProgram>
#include <QString>

#include <cstdint>
#include <memory>
#include <vector>

namespace weave::studio {

/// How one yarn is drawn; bits that the shader knows.
enum YarnState : std::uint8_t { yarn_plain = 0, yarn_dimmed = 1, yarn_hovered = 2, yarn_selected = 4 };

/// Everything about a picture but the yarns.
struct TubeFrame {
    Camera camera;
    PictureSize size;  ///< of the target, pixels of the device
    Shown shown;
    double scale =
        1;  ///< pixels that are computed for one of the target, across: below 1 to be quick, 2 to be smooth
    bool coarse = true;    ///< whether fewer pieces are drawn where nobody can tell
    bool hollows = false;  ///< whether yarns keep light from one another
    Colour ground_top{0xfb, 0xfc, 0xfd}, ground_bottom{0xe4, 0xe8, 0xec}, mark{0x00, 0x72, 0xb2};
    double dim = 0.72;       ///< how much of the ground shows in dimmed yarns
    double mark_pixels = 2;  ///< of the target
};

/// Draws a model with OpenGL 3.3. It needs its context current in every call but the constructor. Of a
/// picture it keeps what is seen where, so that yarns are emphasised without looking for them again.
class TubePainter {
  public:
    TubePainter() = default;
    ~TubePainter() = default;  ///< release() first
    TubePainter(const TubePainter&) = delete;
    TubePainter& operator=(const TubePainter&) = delete;

    /// Makes what lives in the context; what ails it, where it cannot: then nothing must be drawn.
    [[nodiscard]] QString start();
    void release();
    [[nodiscard]] bool has_started() const { return m_gl != nullptr; }

    /// What to draw from now on; null: nothing. The model must live until another is set.
    void set_model(const TubeModel* model);
    /// The model's knots have moved, or have other values.
    void touch_knots() { m_knots_are_old = true; }
    /// One state of YarnState for each yarn.
    void set_states(std::vector<std::uint8_t> states);

    void draw(const TubeFrame& frame, GLuint target);

    [[nodiscard]] QString renderer() const { return m_renderer; }
    /// Whether the processor draws.
    [[nodiscard]] bool is_software() const { return m_is_software; }
    /// Whether the processor finds what is seen, instead of OpenGL; so from the start where OpenGL is drawn
    /// by the processor itself.
    void find_by_processor(bool processor);
    /// Of the last picture that was looked for.
    [[nodiscard]] std::size_t drawn_pieces() const { return m_drawn; }

  private:
    struct List {  ///< numbers in a buffer that shaders read
        GLuint buffer = 0, texture = 0;
        std::size_t bytes = 0;
    };
    struct Sheet {  ///< a picture that is drawn into
        GLuint frame = 0, seen = 0, depth = 0, colour = 0;
        int width = 0, height = 0;
    };
    using Program = std::unique_ptr<QOpenGLShaderProgram>;

    Program program(const QByteArray& vertex, const QByteArray& fragment, QString& trouble);
    void fill(List& list, const void* data, std::size_t bytes, GLenum format, bool often);
    void fill_yarns();
    void fill_indices(std::size_t pieces);
    void upload();
    void make_sheet(int width, int height);
    void drop_sheet();
    void use_camera(QOpenGLShaderProgram& program, const TubeFrame& frame, const Vec3& move);
    void find(const TubeFrame& frame);
    [[nodiscard]] std::vector<PieceRange> ranges_of(const TubeFrame& frame, const Level& level) const;
    void set_depths(const TubeFrame& frame);
    void find_here(const TubeFrame& frame, const std::vector<PieceRange>& ranges);
    void find_there(const TubeFrame& frame, const Level& level, const std::vector<PieceRange>& ranges);
    void light(const TubeFrame& frame, GLuint target);
    void bind(QOpenGLShaderProgram& program);

    QOpenGLFunctions_3_3_Core* m_gl = nullptr;
    QString m_renderer;
    bool m_is_software = false;
    Program m_find[2];   ///< plain; with planes
    Program m_light[4];  ///< bit 0: marked, bit 1: hollows
    GLuint m_vertices = 0, m_indices = 0, m_map = 0;
    std::size_t m_indexed = 0;  ///< pieces that the indices reach
    List m_knots, m_pieces, m_yarns;
    Sheet m_sheet;

    const TubeModel* m_model = nullptr;
    bool m_model_is_old = true, m_knots_are_old = true, m_yarns_are_old = true;
    std::vector<std::uint8_t> m_states;
    bool m_is_marked = false;
    std::size_t m_drawn = 0;
    std::unique_ptr<SoftwareFinder> m_finder;  ///< null: OpenGL finds
    bool m_has_found = false;                  ///< whether the sheet holds m_found
    TubeFrame m_found;
    double m_near = 0, m_far = 1;
};

}  // namespace weave::studio
