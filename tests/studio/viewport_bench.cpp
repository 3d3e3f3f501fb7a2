#include <studio/viewport/tube_painter.hpp>

#include <weave/samples/samples.hpp>

#include <QElapsedTimer>
#include <QOpenGLFramebufferObject>
#include <QOpenGLFunctions>
#include <QtTest>

#include <catch2/catch.hpp>

#include <cstdio>
#include <ctime>
#include <studio/support/offscreen_gl.hpp>

using namespace weave;
using namespace weave::studio;

namespace {

/// A plain weave of as many picks as ends, whose yarns are waves in so many pieces that the whole has about
/// `pieces`.
std::shared_ptr<const Yarns> woven(std::size_t threads, std::size_t layers) {
    auto yarns = std::make_shared<Yarns>();
    const double pitch = 0.5, size = pitch * static_cast<double>(threads);
    yarns->size_mm = {size, size};
    for (std::size_t layer = 0; layer < layers; ++layer) {
        for (std::size_t k = 0; k < 2 * threads; ++k) {
            SimulatedYarn yarn;
            const bool warp = k >= threads;
            yarn.system = warp ? System::warp : System::weft;
            yarn.number = (k % threads) * layers + layer;
            yarn.radius_mm = 0.12;
            yarn.colour = warp ? Colour{0xe6, 0x8a, 0x1e} : Colour{0x4c, 0x84, 0xb8};
            for (std::size_t at = 0; at <= threads; ++at) {
                const bool over = ((at + k) % 2 == 0) == warp;
                const double along = pitch * static_cast<double>(at),
                             aside = pitch * (0.5 + static_cast<double>(k % threads));
                const double height = 0.6 * static_cast<double>(layer) + (over ? 0.12 : -0.12);
                yarn.spline.control.push_back(warp ? Vec3(along, aside, height) : Vec3(aside, along, height));
            }
            yarn.planned = yarn.spline.control;
            yarn.strain.assign(yarn.planned.size(), 0);
            yarn.contact_N = yarn.strain;
            yarns->yarns.push_back(yarn);
        }
    }
    return yarns;
}

/// Wall and processor time of a picture, ms: others may use the machine as well.
struct Cost {
    double wall = 0, processor = 0;
};

Cost time_of(TubePainter& painter, QOpenGLFramebufferObject& target, QOpenGLContext& context, TubeFrame frame,
             int frames, bool turns = true) {
    QElapsedTimer timer;
    std::clock_t before = 0;
    for (int k = -1; k < frames; ++k) {
        if (k == 0) {
            timer.start();
            before = std::clock();
        }
        if (turns) frame.camera.orbit(1.5, 0.2);
        painter.draw(frame, target.handle());
        context.functions()->glFinish();
    }
    return {static_cast<double>(timer.nsecsElapsed()) / 1e6 / frames,
            1000.0 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC / frames};
}

}  // namespace

TEST_CASE("how fast the viewer draws", "[.bench]") {
    test::OffscreenGl gl;
    TubePainter painter;
    REQUIRE(painter.start().isEmpty());
    QOpenGLFramebufferObject target(1280, 800);
    std::printf("GL_RENDERER %s, 1280 x 800\n", qPrintable(painter.renderer()));
    for (const auto& [threads, layers] : {std::pair<std::size_t, std::size_t>{24, 2}, {60, 5}}) {
        auto model = TubeModel::relaxed(woven(threads, layers));
        REQUIRE(model);
        painter.set_model(&*model);
        for (const bool here : {true, false}) {
            painter.find_by_processor(here);
            for (const bool finest : {true, false}) {
                for (const double zoom : {1.0, 4.0}) {
                    if (finest && zoom > 1) continue;
                    for (const double scale : {1.0, 0.5}) {
                        for (const bool hollows : {false, true}) {
                            if (hollows && scale < 1) continue;
                            TubeFrame frame;
                            frame.size = {1280, 800};
                            frame.camera.fit(model->box(), frame.size);
                            frame.camera.height_mm /= zoom;
                            frame.scale = scale;
                            frame.hollows = hollows;
                            frame.coarse = !finest;
                            const Cost cost = time_of(painter, target, gl.context, frame, 6);
                            const Cost light = time_of(painter, target, gl.context, frame, 4, false);
                            std::printf(
                                "%s: %zu capsules, %s, zoom %g, scale %g%s: %zu drawn, %.1f ms a frame (%.1f "
                                "of processors; %.1f "
                                "and %.1f to light alone), %.1f fps\n",
                                here ? "own finder" : "shaders",
                                static_cast<std::size_t>(model->levels().front().count),
                                finest ? "all pieces" : "detail as seen", zoom, scale,
                                hollows ? ", hollows" : "", painter.drawn_pieces(), cost.wall, cost.processor,
                                light.wall, light.processor, 1000 / cost.wall);
                        }
                    }
                }
            }
        }
    }
    painter.release();
}
