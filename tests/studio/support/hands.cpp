#include "hands.hpp"

#include <QtTest>

#include <catch2/catch.hpp>

namespace weave::studio::test {

namespace {

constexpr int patience_ms = 30000;

QString plain(QString text) {
    return text.remove('&');
}

QAction* action_named(const QList<QAction*>& actions, const QString& name) {
    for (QAction* action : actions) {
        if (plain(action->text()) == name) return action;
    }
    return nullptr;
}

/// Looks again and again until `is_there` did what it had to; stops by itself.
class Watcher {
  public:
    explicit Watcher(std::function<bool()> is_there) {
        m_timer.setInterval(10);
        QObject::connect(&m_timer, &QTimer::timeout, [this, is_there = std::move(is_there)] {
            if (m_is_done || m_is_busy) return;
            m_is_busy = true;
            m_is_done = is_there();
            m_is_busy = false;
            if (m_is_done) m_timer.stop();
        });
        m_timer.start();
    }
    [[nodiscard]] bool is_done() const { return m_is_done; }

  private:
    QTimer m_timer;
    bool m_is_done = false, m_is_busy = false;
};

}  // namespace

bool until(const std::function<bool()>& holds) {
    return QTest::qWaitFor(holds, patience_ms);
}

void click(QWidget* widget) {
    REQUIRE(widget != nullptr);
    REQUIRE(widget->isVisible());
    QTest::mouseClick(widget, Qt::LeftButton);
}

void choose(QMainWindow& window, const QStringList& path) {
    QMenuBar* bar = window.menuBar();
    QAction* action = action_named(bar->actions(), path[0]);
    INFO(path.join(" > ").toStdString());
    REQUIRE(action != nullptr);
    QTest::mouseClick(bar, Qt::LeftButton, {}, bar->actionGeometry(action).center());
    QMenu* menu = action->menu();
    for (int k = 1; k < path.size(); ++k) {
        REQUIRE(until([&] { return menu->isVisible(); }));
        action = action_named(menu->actions(), path[k]);
        REQUIRE(action != nullptr);
        REQUIRE(action->isEnabled());
        QTest::mouseMove(menu, menu->actionGeometry(action).center());
        QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(action).center());
        menu = action->menu();
    }
}

void with_dialog(const std::function<void()>& deed, const std::function<void(QDialog&)>& there) {
    const Watcher watcher([&] {
        auto* dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
        if (dialog == nullptr || !dialog->isVisible()) return false;
        there(*dialog);
        return true;
    });
    deed();
    REQUIRE(until([&] { return watcher.is_done(); }));
}

void with_menu(const std::function<void()>& deed, const QString& item) {
    QString seen;
    const Watcher watcher([&] {
        auto* menu = qobject_cast<QMenu*>(QApplication::activePopupWidget());
        if (menu == nullptr || !menu->isVisible()) return false;
        for (QAction* action : menu->actions()) {
            seen += action->text() + "\n";
            if (!plain(action->text()).startsWith(item) || !action->isEnabled()) continue;
            QTest::mouseMove(menu, menu->actionGeometry(action).center());
            QTest::mouseClick(menu, Qt::LeftButton, {}, menu->actionGeometry(action).center());
            return true;
        }
        QTest::keyClick(menu, Qt::Key_Escape);
        return true;
    });
    deed();
    REQUIRE(until([&] { return watcher.is_done(); }));
    INFO("The menu had:\n" << seen.toStdString());
    REQUIRE(seen.remove('&').contains(item));
}

void press(QDialog& dialog, QDialogButtonBox::StandardButton button) {
    QPushButton* found = dialog.findChild<QDialogButtonBox*>()->button(button);
    REQUIRE(found != nullptr);
    REQUIRE(found->isEnabled());
    QTest::mouseClick(found, Qt::LeftButton);
}

void type_number(QSpinBox* box, int number) {
    REQUIRE(box != nullptr);
    box->setFocus();
    box->selectAll();
    QTest::keyClicks(box, QString::number(number));
    QTest::keyClick(box, Qt::Key_Tab);
    REQUIRE(box->value() == number);
}

void choose_entry(QComboBox* box, const QString& text) {
    REQUIRE(box != nullptr);
    const int wanted = box->findText(text, Qt::MatchStartsWith);
    INFO(text.toStdString());
    REQUIRE(wanted >= 0);
    box->setFocus();
    while (box->currentIndex() < wanted) QTest::keyClick(box, Qt::Key_Down);
    while (box->currentIndex() > wanted) QTest::keyClick(box, Qt::Key_Up);
}

void click_item(QTreeWidget& tree, const QString& name) {
    QTreeWidgetItem* found = nullptr;
    REQUIRE(until([&] {
        for (QTreeWidgetItemIterator item(&tree); *item != nullptr; ++item) {
            if ((*item)->text(0).section('\n', 0, 0) == name) found = *item;
        }
        return found != nullptr;
    }));
    tree.scrollToItem(found);
    QTest::mouseClick(tree.viewport(), Qt::LeftButton, {}, tree.visualItemRect(found).center());
}

}  // namespace weave::studio::test
