#pragma once

#include <QtTest>
#include <QtWidgets>

#include <catch2/catch.hpp>

#include <weave/core/file.hpp>

#include <filesystem>
#include <string>
#include <studio/panels/message_bar.hpp>
#include <studio/window/main_window.hpp>
#include <support/temporary_folder.hpp>

#include "hands.hpp"

namespace weave::studio::test {

/// A main window as a person has it before him.
struct Desk {
    explicit Desk(const char* sample = nullptr) {
        window.show();
        REQUIRE(QTest::qWaitForWindowExposed(&window));
        QApplication::setActiveWindow(&window);
        if (sample == nullptr) return;
        window.show_sample(sample);
        settle();
    }
    void settle() {
        REQUIRE(until([&] { return document().shown_is_current() && document().whole().revision == document().revision(); }));
        QCoreApplication::processEvents();
    }
    Document& document() { return *window.document(); }
    template <class Widget>
    Widget& find(const QString& name = {}) {
        auto* found = window.findChild<Widget*>(name);
        REQUIRE(found != nullptr);
        return *found;
    }
    QString said() { return find<MessageBar>("messages").words(); }

    MainWindow window;
};

/// A file with these bytes, to be opened.
inline std::string file_of(const weave::testing::TemporaryFolder& folder, const char* name, const std::string& bytes) {
    const std::filesystem::path path = folder.path / name;
    REQUIRE(write_file(path, bytes));
    return path.string();
}

/// Presses the button of a question that says this.
inline void press(QDialog& dialog, const QString& text) {
    for (QAbstractButton* button : dialog.findChildren<QAbstractButton*>()) {
        if (button->text().remove('&') == text) return QTest::mouseClick(button, Qt::LeftButton);
    }
    FAIL("no button " << text.toStdString());
}

}  // namespace weave::studio::test
