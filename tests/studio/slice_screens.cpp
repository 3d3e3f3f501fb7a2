#include "screen_file.hpp"
#include "slice_case.hpp"

#include <weave/design/evaluate.hpp>

using namespace weave;
using namespace weave::studio;
using namespace weave::studio::test;

TEST_CASE("slice: screens", "[.screens]") {
    const Design design = find_sample("angle-interlock-b")->make();
    const BlockPtr block = evaluate(design).value().block;
    {
        OpenSliceEditor open(warp_slice(*block, 0).value());
        open.key(Qt::Key_S);
        open.click(2, 1);
        (QApplication::processEvents(), open.editor.grab()).save(screen_file("edit.png"));
        open.key(Qt::Key_D);
        QTest::mousePress(&open.canvas(), Qt::LeftButton, Qt::NoModifier, open.canvas().place_of(0, 0));
        for (int k = 0; k < 5; ++k) {
            const QPoint place = open.canvas().place_of(std::size_t(k), k * 1.3);
            QMouseEvent move(QEvent::MouseMove, place, open.canvas().mapToGlobal(place), Qt::NoButton,
                             Qt::LeftButton, Qt::NoModifier);
            QApplication::sendEvent(&open.canvas(), &move);
        }
        (QApplication::processEvents(), open.editor.grab()).save(screen_file("draw.png"));
        QTest::mouseRelease(&open.canvas(), Qt::LeftButton, Qt::NoModifier, open.canvas().place_of(4, 5.2));
        open.key(Qt::Key_S);
        open.click(6, 0);
        open.key(Qt::Key_E);
        open.key(Qt::Key_N);
        open.key(Qt::Key_Left, Qt::ControlModifier);
        (QApplication::processEvents(), open.editor.grab()).save(screen_file("edited.png"));
    }
    {
        OpenSliceEditor open;
        (QApplication::processEvents(), open.editor.grab()).save(screen_file("empty.png"));
    }
    {
        OpenSliceEditor open(weft_slice(*block, 0).value());
        Design wrap;
        wrap.scene.weft_mode = WeftMode::wraparound;
        open.editor.set_design(wrap);
        (QApplication::processEvents(), open.editor.grab()).save(screen_file("wrap.png"));
    }
    SliceEditor editor;
    editor.resize(1200, 600);
    editor.show();
    REQUIRE(QTest::qWaitForWindowExposed(&editor));
    for (const char* name : {"angle-interlock-b", "shoe-adult", "hexagon-tubes"}) {
        const Design sample = find_sample(name)->make();
        const BlockPtr cloth = evaluate(sample).value().block;
        for (const System dots : {System::weft, System::warp}) {
            QElapsedTimer timer;
            timer.start();
            { const BlockSlices once(sample, cloth); }
            const auto read = timer.nsecsElapsed() / 1000;
            editor.show_block(sample, cloth, dots, std::string(name) == "shoe-adult" ? 150 : 0);
            REQUIRE(QTest::qWaitFor([&] { return editor.reader().canvas().slices() != nullptr; }, 60000));
            if (std::string(name) == "shoe-adult")
                editor.reader().canvas().go_to(dots == System::weft ? 500 : 100);
            timer.restart();
            editor.reader().canvas().go_to(editor.reader().canvas().seen().first + 5);
            const auto laid = timer.nsecsElapsed() / 1000;
            timer.restart();
            (QApplication::processEvents(), editor.grab())
                .save(
                    screen_file(QString("read-%1-%2.png").arg(name).arg(dots == System::weft ? "warp" : "weft")));
            std::printf("%s: read %lld us, laid out %lld us, drawn and saved %lld us\n", name,
                        static_cast<long long>(read), static_cast<long long>(laid),
                        static_cast<long long>(timer.nsecsElapsed() / 1000));
        }
    }
}
