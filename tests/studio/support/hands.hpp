#pragma once

#include <QtWidgets>

#include <functional>

namespace weave::studio::test {

/// What a person does with mouse and keys, for stories. Whatever opens a dialog or a menu and waits for it is given what is to be
/// done there beforehand.

/// Waits until something holds, at most half a minute.
bool until(const std::function<bool()>& holds);

/// Clicks in the middle of a widget.
void click(QWidget* widget);
/// Clicks through the menus of a window: `Block`, `Add a traditional weave …`. An ampersand in their names counts for nothing.
void choose(QMainWindow& window, const QStringList& path);
/// Does `deed`, and in the dialog or menu that it opens, `there`. Fails where none opens.
void with_dialog(const std::function<void()>& deed, const std::function<void(QDialog&)>& there);
void with_menu(const std::function<void()>& deed, const QString& item);
/// Presses a button of a dialog.
void press(QDialog& dialog, QDialogButtonBox::StandardButton button);
/// Types a number into a box in place of the one that is there.
void type_number(QSpinBox* box, int number);
/// Chooses an entry of a list with the keys.
void choose_entry(QComboBox* box, const QString& text);
/// Clicks the item of a tree whose first line is this.
void click_item(QTreeWidget& tree, const QString& name);

}  // namespace weave::studio::test
