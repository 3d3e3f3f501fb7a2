#pragma once

#include <weave/block/slice_moves.hpp>
#include <weave/samples/samples.hpp>
#include <studio/editors/slice_editor.hpp>

#include <QtTest>

#include <catch2/catch.hpp>

#include <string>
#include <vector>

namespace weave::studio::test {

inline Slice slice_of(System dots, const std::vector<std::string>& positions) {
    Slice slice{dots, {}};
    for (const auto& text : positions) slice.positions.push_back(parse_slice_position(text).value());
    return slice;
}

/// The card of a slice, picks from the first, `#` where the end is lifted.
inline std::vector<std::string> card_of(const Slice& slice) {
    const CardImage card = to_block(slice).value().card_image();
    std::vector<std::string> rows;
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        std::string& row = rows.emplace_back();
        for (std::size_t end = 0; end < card.ends(); ++end) row += card.weft_over(pick, end) ? '.' : '#';
    }
    return rows;
}
using Rows = std::vector<std::string>;

/// A slice editor in a window, and what it said.
struct OpenSliceEditor {
    SliceEditor editor;
    std::vector<Slice> edits;
    std::vector<QString> names;
    QString status;

    explicit OpenSliceEditor(const Slice& slice = {}) {
        QObject::connect(&editor, &SliceEditor::edited, &editor,
                         [this](const Slice& edited, const QString& what) {
                             edits.push_back(edited);
                             names.push_back(what);
                         });
        QObject::connect(&editor, &SliceEditor::status, &editor,
                         [this](const QString& words) { status = words; });
        editor.resize(1000, 560);
        editor.show();
        REQUIRE(QTest::qWaitForWindowExposed(&editor));
        editor.show_slice(slice);
    }
    SliceEditCanvas& canvas() { return editor.canvas(); }
    [[nodiscard]] const Slice& slice() { return editor.canvas().slice(); }
    [[nodiscard]] QString last_name() const { return names.empty() ? QString() : names.back(); }
    [[nodiscard]] QString bubble() {
        const auto* label = editor.canvas().findChild<QLabel*>("bubble");
        return label != nullptr && label->isVisible() ? label->text() : QString();
    }
    void key(int key, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
        QTest::keyClick(&canvas(), Qt::Key(key), modifiers);
    }
    void click(std::size_t position, double level, Qt::KeyboardModifiers modifiers = Qt::NoModifier) {
        QTest::mouseClick(&canvas(), Qt::LeftButton, modifiers, canvas().place_of(position, level));
    }
    /// Presses at the first place, goes along the others and releases at the last.
    void drag(const std::vector<QPoint>& places) {
        QTest::mousePress(&canvas(), Qt::LeftButton, Qt::NoModifier, places.front());
        for (const QPoint place : places) {
            QMouseEvent move(QEvent::MouseMove, place, canvas().mapToGlobal(place), Qt::NoButton,
                             Qt::LeftButton, Qt::NoModifier);
            QApplication::sendEvent(&canvas(), &move);
        }
        QTest::mouseRelease(&canvas(), Qt::LeftButton, Qt::NoModifier, places.back());
    }
};

}  // namespace weave::studio::test
