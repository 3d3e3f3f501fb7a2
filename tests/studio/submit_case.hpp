#pragma once

#include <weave/design/document.hpp>
#include <weave/design/evaluate.hpp>
#include <weave/samples/samples.hpp>

#include <QComboBox>
#include <QLabel>
#include <QLineEdit>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QTextBrowser>
#include <QtTest>

#include <catch2/catch.hpp>
#include <functional>
#include <string>
#include <studio/panels/submit_panel.hpp>
#include <studio/support/mill.hpp>

namespace weave::studio::test {

using namespace std::chrono_literals;

/// A panel in a window of its own, used as a person uses it.
class SubmitWindow {
  public:
    explicit SubmitWindow(const std::filesystem::path& session) : panel(session) {
        panel.desk().set_interval(100ms);
        panel.resize(620, 1150);
        panel.show();
        REQUIRE(QTest::qWaitForWindowExposed(&panel));
        open_sample("pocket");
    }
    /// Of dora, a designer, who is signed in.
    explicit SubmitWindow(const Mill& mill) : SubmitWindow(mill.session_of("dora")) { wait_signed_in(); }

    void open_sample(const std::string& name) { open(find_sample(name)->make()); }
    void open(const Design& made) {
        design = made;
        auto evaluation = evaluate(design);
        REQUIRE(evaluation);
        panel.set_design(design, evaluation->block, ++edition);
    }
    template <class Widget>
    Widget& find(const char* name) {
        auto* found = panel.findChild<Widget*>(name);
        INFO(name);
        REQUIRE(found != nullptr);
        return *found;
    }
    QString text(const char* label) { return find<QLabel>(label).text(); }
    void type(const char* field, const std::string& words) {
        auto& line = find<QLineEdit>(field);
        line.setFocus();
        line.selectAll();
        QTest::keyClick(&line, Qt::Key_Delete);
        QTest::keyClicks(&line, QString::fromStdString(words));
    }
    /// How far below the top of the panel it stands, once all has found its place.
    int place_of(const char* field) {
        (void)wait([settled = 0]() mutable { return ++settled > 5; });  // one layout asks for another
        return find<QWidget>(field).mapTo(&panel, QPoint()).y();
    }
    void write_note(const std::string& words) {
        auto& note = find<QPlainTextEdit>("note");
        note.setFocus();
        note.selectAll();
        QTest::keyClicks(&note, QString::fromStdString(words));
    }
    void click(const char* button) {
        auto& found = find<QPushButton>(button);
        INFO(button << ": " << text("hint").toStdString());
        REQUIRE(wait([&] { return found.isEnabled() && found.isVisible(); }));
        QTest::mouseClick(&found, Qt::LeftButton);
    }
    bool wait(const std::function<bool()>& so) const { return QTest::qWaitFor(so, 60'000); }
    void wait_for(const char* label, const QString& words) {
        const bool came = wait([&] { return text(label).contains(words); });
        INFO(label << " says: " << text(label).toStdString());
        INFO("trouble: " << text("trouble").toStdString() << "; hint: " << text("hint").toStdString());
        REQUIRE(came);
    }
    QString talk() { return find<QTextBrowser>("talk").toPlainText(); }

    void sign_in(const Mill& mill, const std::string& password = Mill::password) {
        type("mill", mill.origin());
        type("fingerprint", mill.fingerprint());
        type("person", "dora");
        type("password", password);
        click("sign_in");
    }
    void wait_signed_in() {
        REQUIRE(wait([&] { return panel.desk().access().signed_in; }));
    }
    /// Saves a revision, the first under this name.
    void save(const std::string& name, const std::string& note) {
        type("new_design", name);
        write_note(note);
        click("save_revision");
    }
    void submit(const std::string& note) {
        write_note(note);
        type("signing_password", Mill::password);
        click("submit");
    }

    SubmitPanel panel;
    Design design;
    std::uint64_t edition = 0;
};

}  // namespace weave::studio::test
