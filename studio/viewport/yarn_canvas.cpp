#include <studio/viewport/yarn_canvas.hpp>

#include <studio/viewport/found_gl.hpp>

#include <QOffscreenSurface>
#include <QOpenGLContext>
#include <QOpenGLFramebufferObject>
#include <QOpenGLFunctions>
#include <QOpenGLWidget>
#include <QPainter>

#include <cmath>
#include <utility>

namespace weave::studio {

namespace {

/// Straight into the window.
class WindowCanvas : public QOpenGLWidget, public YarnCanvas {
  public:
    WindowCanvas(Owner owner, QWidget* parent) : QOpenGLWidget(parent), m_owner(std::move(owner)) { setFormat(wanted_gl()); }
    ~WindowCanvas() override {
        if (context() != nullptr) disconnect(context(), nullptr, this, nullptr);
    }

    QWidget& widget() override { return *this; }
    void draw_again() override { update(); }
    void make_current() override { makeCurrent(); }
    void done_current() override { doneCurrent(); }
    [[nodiscard]] bool has_context() const override { return context() != nullptr; }
    QImage yarns() override { return grabFramebuffer(); }

  protected:
    void initializeGL() override {
        connect(context(), &QOpenGLContext::aboutToBeDestroyed, this, [this] {
            makeCurrent();
            m_owner.release();
            doneCurrent();
        });
        m_owner.start();
    }
    void paintGL() override { m_owner.draw(defaultFramebufferObject()); }

  private:
    Owner m_owner;
};

/// Into a picture of its own, which is drawn when there is something new to see.
class PictureCanvas : public QWidget, public YarnCanvas {
  public:
    PictureCanvas(Owner owner, QWidget* parent) : QWidget(parent), m_owner(std::move(owner)) { setAttribute(Qt::WA_OpaquePaintEvent); }
    ~PictureCanvas() override {
        PictureCanvas::make_current();
        m_target.reset();
        PictureCanvas::done_current();
    }

    QWidget& widget() override { return *this; }
    void draw_again() override {
        m_is_old = true;
        update();
    }
    void make_current() override { m_context.makeCurrent(&m_surface); }
    void done_current() override { m_context.doneCurrent(); }
    [[nodiscard]] bool has_context() const override { return m_context.isValid(); }
    QImage yarns() override {
        draw();
        return m_picture;
    }

  protected:
    void paintEvent(QPaintEvent*) override {
        if (m_is_old || size_to_draw() != m_picture.size()) draw();
        QPainter(this).drawImage(QPointF(), m_picture);
    }
    /// Colours of the palette may be in the picture.
    void changeEvent(QEvent* event) override {
        m_is_old = true;
        QWidget::changeEvent(event);
    }

  private:
    [[nodiscard]] QSize size_to_draw() const {
        const auto pixels = [this](int length) { return std::max(1, static_cast<int>(std::lround(length * devicePixelRatioF()))); };
        return {pixels(width()), pixels(height())};
    }

    void start() {
        m_context.setFormat(wanted_gl());
        if (m_context.create()) {
            m_surface.setFormat(m_context.format());
            m_surface.create();
        }
        make_current();
        m_owner.start();
    }

    void draw() {
        if (!std::exchange(m_has_started, true)) start();
        make_current();
        const QSize size = size_to_draw();
        if (m_target == nullptr || m_target->size() != size) m_target = std::make_unique<QOpenGLFramebufferObject>(size);
        m_owner.draw(m_target->handle());
        read(size);
        done_current();
        m_is_old = false;
    }

    void read(const QSize& size) {
        if (m_picture.size() != size) m_picture = QImage(size, QImage::Format_RGB32);
        m_target->bind();
        m_context.functions()->glPixelStorei(GL_PACK_ALIGNMENT, 4);
        m_context.functions()->glReadPixels(0, 0, size.width(), size.height(), GL_BGRA, GL_UNSIGNED_BYTE, m_picture.bits());
        m_target->release();
        m_picture = std::move(m_picture).mirrored();  // its first line was the lowest
        m_picture.setDevicePixelRatio(devicePixelRatioF());
    }

    Owner m_owner;
    QOffscreenSurface m_surface;
    QOpenGLContext m_context;
    std::unique_ptr<QOpenGLFramebufferObject> m_target;
    QImage m_picture;
    bool m_has_started = false, m_is_old = true;
};

}  // namespace

std::unique_ptr<YarnCanvas> make_yarn_canvas(bool is_software, YarnCanvas::Owner owner, QWidget* parent) {
    std::unique_ptr<YarnCanvas> canvas;
    if (is_software) canvas = std::make_unique<PictureCanvas>(std::move(owner), parent);
    else canvas = std::make_unique<WindowCanvas>(std::move(owner), parent);
    canvas->widget().setAttribute(Qt::WA_TransparentForMouseEvents);
    canvas->widget().setFocusPolicy(Qt::NoFocus);
    return canvas;
}

}  // namespace weave::studio
