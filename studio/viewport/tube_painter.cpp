#include <studio/viewport/tube_painter.hpp>

#include <weave/picture/colour_map.hpp>
#include <studio/viewport/found_gl.hpp>
#include <studio/viewport/shaders.hpp>

#include <QCoreApplication>
#include <QOpenGLContext>
#include <QOpenGLVersionFunctionsFactory>

#include <algorithm>
#include <cmath>

namespace weave::studio {

namespace {

constexpr double level_pixels = 0.4;  ///< no piece strays further from its yarn on the screen
enum Unit : int { unit_knots, unit_pieces, unit_yarns, unit_seen, unit_depth, unit_map };

QVector3D vector_of(const Vec3& place) {
    return {static_cast<float>(place.x()), static_cast<float>(place.y()), static_cast<float>(place.z())};
}

QVector3D vector_of(Colour colour) {
    return QVector3D(colour.red, colour.green, colour.blue) / 255.0F;
}

Vec3 turned(const Camera& camera, const Vec3& way) {
    return {way.dot(camera.right()), way.dot(camera.up()), way.dot(camera.away())};
}

Vec3 move_of(const TubeModel& model, std::size_t i, std::size_t j) {
    return {static_cast<double>(i) * model.size_mm()[0], static_cast<double>(j) * model.size_mm()[1], 0};
}

/// The coarsest level that nobody can tell from the yarns.
const Level& level_for(const TubeModel& model, const TubeFrame& frame) {
    const Camera& camera = frame.camera;
    double pixels_per_mm = camera.scale(frame.size) * std::min(frame.scale, 1.0);
    if (camera.perspective) {  // of the nearest yarn
        double nearest = camera.distance();
        for (const Vec3& corner : box_of(model, frame.shown.repeat).corners())
            nearest = std::min(nearest, camera.to_camera(corner).z());
        pixels_per_mm *= camera.distance() / std::max(nearest, 0.1 * camera.distance());
    }
    const Level* best = &model.levels().front();
    for (const Level& level : model.levels()) {
        if (frame.coarse && level.error_mm * pixels_per_mm <= level_pixels) best = &level;
    }
    return *best;
}

/// Tells which chunks a picture may show, by half spaces: what lies wholly in front of one of them is left
/// out.
class Sieve {
  public:
    Sieve(const TubeFrame& frame, const Vec3& move) {
        const Camera& camera = frame.camera;
        const double half = camera.height_mm / 2, wide = half * frame.size.width / frame.size.height;
        const Vec3 right = camera.right(), up = camera.up(), away = camera.away(),
                   centre = camera.centre - move;
        const auto add = [&](const Vec3& side, double reach) {
            if (camera.perspective) {  // through the eye
                const Vec3 normal = side * camera.distance() - away * reach;
                m_planes.push_back({normal, normal.dot(centre - away * camera.distance())});
            } else {
                m_planes.push_back({side, side.dot(centre) + reach});
            }
        };
        add(right, wide);
        add(-right, wide);
        add(up, half);
        add(-up, half);
        if (frame.shown.clip) {
            const Plane& clip = *frame.shown.clip;
            m_planes.push_back({clip.normal, clip.height - clip.normal.dot(move)});
        }
    }

    [[nodiscard]] bool keeps(const Chunk& chunk) const {
        return std::ranges::none_of(m_planes, [&](const Plane& plane) {
            double least = 0;  // of the box along the normal
            for (int axis = 0; axis < 3; ++axis)
                least +=
                    plane.normal[axis] * double{plane.normal[axis] > 0 ? chunk.low[axis] : chunk.high[axis]};
            return least > plane.height;
        });
    }

  private:
    std::vector<Plane> m_planes;
};

bool same_sight(const TubeFrame& a, const TubeFrame& b) {
    return a.camera == b.camera && a.size.width == b.size.width && a.size.height == b.size.height &&
           a.shown == b.shown && a.scale == b.scale && a.coarse == b.coarse;
}

}  // namespace

TubePainter::Program TubePainter::program(const QByteArray& vertex, const QByteArray& fragment,
                                          QString& trouble) {
    auto made = std::make_unique<QOpenGLShaderProgram>();
    if (!made->addShaderFromSourceCode(QOpenGLShader::Vertex, vertex) ||
        !made->addShaderFromSourceCode(QOpenGLShader::Fragment, fragment) || !made->link()) {
        trouble = QCoreApplication::translate("TubePainter",
                                              "the graphics driver refuses the viewer's programs: %1")
                      .arg(made->log().left(300));
    }
    return made;
}

QString TubePainter::start() {
    auto* const context = QOpenGLContext::currentContext();
    auto* const gl = context == nullptr
                         ? nullptr
                         : QOpenGLVersionFunctionsFactory::get<QOpenGLFunctions_3_3_Core>(context);
    if (gl == nullptr || !gl->initializeOpenGLFunctions())
        return QCoreApplication::translate("TubePainter", "the graphics driver has no OpenGL 3.3");
    const auto* const name = reinterpret_cast<const char*>(gl->glGetString(GL_RENDERER));
    m_renderer = QString::fromUtf8(name);
    m_is_software = is_software_renderer(m_renderer);
    find_by_processor(m_is_software);
    QString trouble;
    m_find[0] = program(shaders::vertex({}), shaders::find({}), trouble);
    m_find[1] = program(shaders::vertex({"PLANES"}), shaders::find({"PLANES"}), trouble);
    m_light[0] = program(shaders::whole({}), shaders::light({}), trouble);
    m_light[1] = program(shaders::whole({}), shaders::light({"MARKED"}), trouble);
    m_light[2] = program(shaders::whole({}), shaders::light({"HOLLOWS"}), trouble);
    m_light[3] = program(shaders::whole({}), shaders::light({"MARKED", "HOLLOWS"}), trouble);
    if (!trouble.isEmpty()) return trouble;
    m_gl = gl;
    m_gl->glGenVertexArrays(1, &m_vertices);
    m_gl->glGenBuffers(1, &m_indices);
    m_gl->glGenTextures(1, &m_map);
    std::vector<std::uint8_t> map;
    for (int k = 0; k < 256; ++k) {
        const Colour colour = map_colour(k / 255.0);
        map.insert(map.end(), {colour.red, colour.green, colour.blue, 255});
    }
    m_gl->glBindTexture(GL_TEXTURE_2D, m_map);
    m_gl->glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 256, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, map.data());
    m_gl->glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    m_gl->glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    m_gl->glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    m_model_is_old = m_knots_are_old = m_yarns_are_old = true;
    return {};
}

void TubePainter::release() {
    if (m_gl == nullptr) return;
    for (Program& program : m_find) program.reset();
    for (Program& program : m_light) program.reset();
    drop_sheet();
    for (List* list : {&m_knots, &m_pieces, &m_yarns}) {
        m_gl->glDeleteTextures(1, &list->texture);
        m_gl->glDeleteBuffers(1, &list->buffer);
        *list = {};
    }
    m_gl->glDeleteTextures(1, &m_map);
    m_gl->glDeleteBuffers(1, &m_indices);
    m_gl->glDeleteVertexArrays(1, &m_vertices);
    m_map = m_indices = m_vertices = 0;
    m_indexed = 0;
    m_gl = nullptr;
    m_model_is_old = m_knots_are_old = m_yarns_are_old = true;
}

void TubePainter::set_model(const TubeModel* model) {
    m_model = model;
    m_model_is_old = m_knots_are_old = m_yarns_are_old = true;
    m_states.assign(model == nullptr ? 0 : model->yarns().size(), yarn_plain);
    m_is_marked = false;
}

void TubePainter::set_states(std::vector<std::uint8_t> states) {
    if (states == m_states) return;
    m_states = std::move(states);
    m_is_marked = std::ranges::any_of(
        m_states, [](std::uint8_t state) { return (state & (yarn_hovered | yarn_selected)) != 0; });
    m_yarns_are_old = true;
}

void TubePainter::fill(List& list, const void* data, std::size_t bytes, GLenum format, bool often) {
    if (list.buffer == 0) {
        m_gl->glGenBuffers(1, &list.buffer);
        m_gl->glGenTextures(1, &list.texture);
    }
    m_gl->glBindBuffer(GL_TEXTURE_BUFFER, list.buffer);
    m_gl->glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(bytes), data,
                       often ? GL_DYNAMIC_DRAW : GL_STATIC_DRAW);
    if (list.bytes != bytes) {
        m_gl->glBindTexture(GL_TEXTURE_BUFFER, list.texture);
        m_gl->glTexBuffer(GL_TEXTURE_BUFFER, format, list.buffer);
        list.bytes = bytes;
    }
}

void TubePainter::fill_yarns() {
    std::vector<std::uint32_t> words;
    words.reserve(4 * m_model->yarns().size());
    for (std::size_t y = 0; y < m_model->yarns().size(); ++y) {
        const ModelYarn& yarn = m_model->yarns()[y];
        const std::uint32_t state = y < m_states.size() ? m_states[y] : 0U;
        const std::uint32_t colour = yarn.colour.red | std::uint32_t{yarn.colour.green} << 8 |
                                     std::uint32_t{yarn.colour.blue} << 16 | state << 24;
        words.insert(words.end(), {colour, yarn.first_knot, yarn.last_knot(), 0});
    }
    fill(m_yarns, words.data(), words.size() * sizeof words[0], GL_RGBA32UI, true);
}

/// Two triangles a piece, over four corners that are counted and lie nowhere.
void TubePainter::fill_indices(std::size_t pieces) {
    if (pieces <= m_indexed) return;
    std::vector<std::uint32_t> corners;
    corners.reserve(6 * pieces);
    for (std::size_t k = 0; k < pieces; ++k) {
        const auto first = static_cast<std::uint32_t>(4 * k);
        corners.insert(corners.end(), {first, first + 1, first + 2, first + 2, first + 1, first + 3});
    }
    m_gl->glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, m_indices);
    m_gl->glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(corners.size() * sizeof corners[0]),
                       corners.data(), GL_STATIC_DRAW);
    m_indexed = pieces;
}

void TubePainter::upload() {
    if (m_model_is_old || m_knots_are_old) m_has_found = false;
    m_gl->glBindVertexArray(m_vertices);
    if (m_model_is_old) {
        const auto& pieces = m_model->pieces();
        fill(m_pieces, pieces.data(), pieces.size() * sizeof pieces[0], GL_RGBA32UI, false);
        fill_indices(pieces.size());
    }
    if (m_knots_are_old) {
        const auto& knots = m_model->knots();
        fill(m_knots, knots.data(), knots.size() * sizeof knots[0], GL_RGBA32F, true);
    }
    if (m_yarns_are_old || m_knots_are_old) fill_yarns();
    m_model_is_old = m_knots_are_old = m_yarns_are_old = false;
}

void TubePainter::drop_sheet() {
    m_gl->glDeleteFramebuffers(1, &m_sheet.frame);
    for (const GLuint* texture : {&m_sheet.seen, &m_sheet.depth, &m_sheet.colour})
        m_gl->glDeleteTextures(1, texture);
    m_sheet = {};
    m_has_found = false;
}

void TubePainter::make_sheet(int width, int height) {
    if (m_sheet.frame != 0 && m_sheet.width == width && m_sheet.height == height) return;
    drop_sheet();
    m_sheet.width = width;
    m_sheet.height = height;
    const auto texture = [&](GLuint& name, int inner, GLenum format, GLenum type, GLenum place) {
        m_gl->glGenTextures(1, &name);
        m_gl->glBindTexture(GL_TEXTURE_2D, name);
        m_gl->glTexImage2D(GL_TEXTURE_2D, 0, inner, width, height, 0, format, type, nullptr);
        m_gl->glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        m_gl->glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        m_gl->glFramebufferTexture2D(GL_FRAMEBUFFER, place, GL_TEXTURE_2D, name, 0);
    };
    m_gl->glGenFramebuffers(1, &m_sheet.frame);
    m_gl->glBindFramebuffer(GL_FRAMEBUFFER, m_sheet.frame);
    texture(m_sheet.seen, GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT, GL_COLOR_ATTACHMENT0);
    texture(m_sheet.colour, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_COLOR_ATTACHMENT1);
    texture(m_sheet.depth, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, GL_DEPTH_ATTACHMENT);
}

void TubePainter::use_camera(QOpenGLShaderProgram& program, const TubeFrame& frame, const Vec3& move) {
    const Camera& camera = frame.camera;
    program.bind();
    program.setUniformValue("u_knots", int{unit_knots});
    program.setUniformValue("u_pieces", int{unit_pieces});
    program.setUniformValue("u_yarns", int{unit_yarns});
    program.setUniformValue("u_right", vector_of(camera.right()));
    program.setUniformValue("u_up", vector_of(camera.up()));
    program.setUniformValue("u_away", vector_of(camera.away()));
    program.setUniformValue("u_centre", vector_of(camera.centre - move));
    program.setUniformValue("u_distance", static_cast<float>(camera.distance()));
    const double half = camera.height_mm / 2;
    program.setUniformValue("u_half", static_cast<float>(half * frame.size.width / frame.size.height),
                            static_cast<float>(half));
    program.setUniformValue("u_range", static_cast<float>(m_near), static_cast<float>(1 / (m_far - m_near)));
    program.setUniformValue("u_pixel", 2.0F / static_cast<float>(m_sheet.width),
                            2.0F / static_cast<float>(m_sheet.height));
    QVector4D clip;
    if (frame.shown.clip) {  // the camera sees the same plane for every repeat
        const Vec3 normal = turned(camera, frame.shown.clip->normal);
        const double height =
            normal.dot(camera.to_camera(frame.shown.clip->height * frame.shown.clip->normal));
        clip = {vector_of(normal), static_cast<float>(height)};
    }
    program.setUniformValue("u_clip", clip);
}

void TubePainter::bind(QOpenGLShaderProgram& program) {
    program.bind();
    const std::pair<int, GLuint> lists[]{
        {unit_knots, m_knots.texture}, {unit_pieces, m_pieces.texture}, {unit_yarns, m_yarns.texture}};
    for (const auto& [unit, texture] : lists) {
        m_gl->glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        m_gl->glBindTexture(GL_TEXTURE_BUFFER, texture);
    }
}

void TubePainter::find_by_processor(bool processor) {
    m_finder = processor ? std::make_unique<SoftwareFinder>() : nullptr;
    m_has_found = false;
}

void TubePainter::set_depths(const TubeFrame& frame) {
    m_near = std::numeric_limits<double>::infinity();
    m_far = -m_near;
    for (const Vec3& corner : box_of(*m_model, frame.shown.repeat).corners()) {
        const double away = frame.camera.to_camera(corner).z();
        m_near = std::min(m_near, away);
        m_far = std::max(m_far, away);
    }
    const double rim = 0.01 * (m_far - m_near) + 2 * m_model->thinnest_mm();
    m_near = frame.camera.perspective ? std::max(m_near - rim, 0.0) : m_near - rim;
    m_far = std::max(m_far + rim, m_near + rim);
}

/// The pieces that a picture may show, of each repeat those that are not flat first.
std::vector<PieceRange> TubePainter::ranges_of(const TubeFrame& frame, const Level& level) const {
    std::vector<PieceRange> ranges;
    for (std::size_t i = 0; i < frame.shown.repeat[0]; ++i) {
        for (std::size_t j = 0; j < frame.shown.repeat[1]; ++j) {
            const Sieve sieve(frame, move_of(*m_model, i, j));
            bool joins = false;
            for (const Chunk& chunk : level.chunks) {
                if (!sieve.keeps(chunk)) {
                    joins = false;
                    continue;
                }
                joins = joins && chunk.first != level.first_flat;
                if (joins) {
                    ranges.back().count += chunk.count;
                } else {
                    ranges.push_back({chunk.first, chunk.count, i, j});
                }
                joins = true;
            }
        }
    }
    return ranges;
}

void TubePainter::find(const TubeFrame& frame) {
    const auto width = std::max(1, static_cast<int>(std::lround(frame.size.width * frame.scale))),
               height = std::max(1, static_cast<int>(std::lround(frame.size.height * frame.scale)));
    make_sheet(width, height);
    set_depths(frame);
    const Level& level = level_for(*m_model, frame);
    const std::vector<PieceRange> ranges = ranges_of(frame, level);
    m_drawn = 0;
    for (const PieceRange& range : ranges) m_drawn += range.count;
    if (m_finder != nullptr) {
        find_here(frame, ranges);
    } else {
        find_there(frame, level, ranges);
    }
    m_found = frame;
    m_has_found = true;
}

void TubePainter::find_here(const TubeFrame& frame, const std::vector<PieceRange>& ranges) {
    m_finder->run(*m_model, {frame.camera, frame.size, m_sheet.width, m_sheet.height, m_near, m_far,
                             frame.shown.clip, ranges});
    m_gl->glActiveTexture(GL_TEXTURE0);
    m_gl->glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    m_gl->glBindTexture(GL_TEXTURE_2D, m_sheet.seen);
    m_gl->glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, m_sheet.width, m_sheet.height, GL_RG_INTEGER,
                          GL_UNSIGNED_INT, m_finder->seen().data());
    m_gl->glBindTexture(GL_TEXTURE_2D, m_sheet.depth);
    m_gl->glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, m_sheet.width, m_sheet.height, GL_DEPTH_COMPONENT, GL_FLOAT,
                          m_finder->depth().data());
}

void TubePainter::find_there(const TubeFrame& frame, const Level& level,
                             const std::vector<PieceRange>& ranges) {
    m_gl->glBindFramebuffer(GL_FRAMEBUFFER, m_sheet.frame);
    m_gl->glDrawBuffer(GL_COLOR_ATTACHMENT0);
    m_gl->glViewport(0, 0, m_sheet.width, m_sheet.height);
    m_gl->glDisable(GL_BLEND);
    m_gl->glDisable(GL_SCISSOR_TEST);
    m_gl->glDisable(GL_CULL_FACE);
    m_gl->glEnable(GL_DEPTH_TEST);
    m_gl->glDepthFunc(GL_LESS);
    m_gl->glDepthMask(GL_TRUE);
    constexpr GLuint nothing[4]{};
    constexpr float far[1]{1};
    m_gl->glClearBufferuiv(GL_COLOR, 0, nothing);
    m_gl->glClearBufferfv(GL_DEPTH, 0, far);
    m_gl->glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, m_indices);
    // Those of one repeat and one program at a time.
    for (std::size_t at = 0; at < ranges.size();) {
        const PieceRange& first = ranges[at];
        const bool flat = first.first >= level.first_flat;
        std::vector<GLsizei> counts;
        std::vector<const void*> starts;
        for (; at < ranges.size() && ranges[at].i == first.i && ranges[at].j == first.j &&
               (ranges[at].first >= level.first_flat) == flat;
             ++at) {
            counts.push_back(static_cast<GLsizei>(6 * ranges[at].count));
            starts.push_back(
                reinterpret_cast<const void*>(std::uintptr_t{6} * ranges[at].first * sizeof(std::uint32_t)));
        }
        QOpenGLShaderProgram& program = *m_find[flat || frame.shown.clip ? 1 : 0];
        bind(program);
        use_camera(program, frame, move_of(*m_model, first.i, first.j));
        m_gl->glUniform1ui(program.uniformLocation("u_copy"), static_cast<GLuint>(first.i | first.j << 4U));
        m_gl->glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_INT, starts.data(),
                                  static_cast<GLsizei>(counts.size()));
    }
}

void TubePainter::light(const TubeFrame& frame, GLuint target) {
    const bool direct = m_sheet.width == static_cast<int>(frame.size.width) &&
                        m_sheet.height == static_cast<int>(frame.size.height);
    QOpenGLShaderProgram& program = *m_light[(m_is_marked ? 1 : 0) | (frame.hollows ? 2 : 0)];
    m_gl->glBindFramebuffer(GL_FRAMEBUFFER, direct ? target : m_sheet.frame);
    if (!direct) m_gl->glDrawBuffer(GL_COLOR_ATTACHMENT1);
    m_gl->glViewport(0, 0, m_sheet.width, m_sheet.height);
    m_gl->glDisable(GL_DEPTH_TEST);
    m_gl->glDisable(GL_BLEND);
    bind(program);
    use_camera(program, frame, Vec3::Zero());
    const std::pair<int, GLuint> pictures[]{
        {unit_seen, m_sheet.seen}, {unit_depth, m_sheet.depth}, {unit_map, m_map}};
    for (const auto& [unit, texture] : pictures) {
        m_gl->glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        m_gl->glBindTexture(GL_TEXTURE_2D, texture);
    }
    program.setUniformValue("u_seen", int{unit_seen});
    program.setUniformValue("u_depth", int{unit_depth});
    program.setUniformValue("u_map", int{unit_map});
    program.setUniformValue("u_top", vector_of(frame.ground_top));
    program.setUniformValue("u_bottom", vector_of(frame.ground_bottom));
    program.setUniformValue("u_mark", vector_of(frame.mark));
    const bool scalar = m_model->is_scalar();
    program.setUniformValue("u_values", static_cast<float>(m_model->low()),
                            scalar ? static_cast<float>(1 / (m_model->high() - m_model->low())) : 0.0F);
    program.setUniformValue("u_period_x", vector_of(turned(frame.camera, {m_model->size_mm()[0], 0, 0})));
    program.setUniformValue("u_period_y", vector_of(turned(frame.camera, {0, m_model->size_mm()[1], 0})));
    program.setUniformValue("u_dim", static_cast<float>(frame.dim));
    const double radius_px =
        m_model->thinnest_mm() * frame.camera.scale({double(m_sheet.width), double(m_sheet.height)});
    program.setUniformValue("u_reach", static_cast<float>(std::clamp(2.2 * radius_px, 2.0, 60.0)));
    program.setUniformValue("u_mark_width",
                            static_cast<float>(std::max(1.0, frame.mark_pixels * frame.scale)));
    m_gl->glDrawArrays(GL_TRIANGLES, 0, 3);
    if (!direct) {
        m_gl->glBindFramebuffer(GL_READ_FRAMEBUFFER, m_sheet.frame);
        m_gl->glReadBuffer(GL_COLOR_ATTACHMENT1);
        m_gl->glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
        m_gl->glBlitFramebuffer(0, 0, m_sheet.width, m_sheet.height, 0, 0, static_cast<int>(frame.size.width),
                                static_cast<int>(frame.size.height), GL_COLOR_BUFFER_BIT, GL_LINEAR);
        m_gl->glBindFramebuffer(GL_FRAMEBUFFER, target);
    }
    program.release();
    m_gl->glActiveTexture(GL_TEXTURE0);
}

void TubePainter::draw(const TubeFrame& frame, GLuint target) {
    if (m_gl == nullptr || m_model == nullptr) return;
    upload();
    if (!m_has_found || !same_sight(frame, m_found)) find(frame);
    light(frame, target);
    m_gl->glBindVertexArray(0);
}

}  // namespace weave::studio
