#pragma once

#include <QImage>
#include <QWidget>

#include <functional>
#include <memory>

namespace weave::studio {

/// Where yarns are drawn with OpenGL, as a widget that takes no mouse.
///
/// A graphics card draws straight into the window. Where OpenGL is a program of the processor that would make the whole window,
/// with all that stands beside the yarns, be composed by that program at each repaint (25 to 40 ms at 1680 × 1040 with llvmpipe):
/// there the yarns are drawn apart, into a picture that the window shows like any other.
class YarnCanvas {
  public:
    /// What its owner does when it is asked; each with the context current.
    struct Owner {
        std::function<void()> start, release;
        std::function<void(unsigned target)> draw;  ///< into this framebuffer, all of it
    };

    virtual ~YarnCanvas() = default;
    virtual QWidget& widget() = 0;
    /// The yarns have changed, or are looked at otherwise.
    virtual void draw_again() = 0;
    virtual void make_current() = 0;
    virtual void done_current() = 0;
    [[nodiscard]] virtual bool has_context() const = 0;
    /// The yarns as they would be shown now.
    virtual QImage yarns() = 0;
};

/// The canvas lies in its parent; release() has been called before it goes.
std::unique_ptr<YarnCanvas> make_yarn_canvas(bool is_software, YarnCanvas::Owner owner, QWidget* parent);

}  // namespace weave::studio
