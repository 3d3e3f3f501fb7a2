#pragma once

#include <QAction>
#include <QKeyEvent>
#include <QWidget>

#include <initializer_list>

namespace weave::studio {

/// The action of a widget that has this key and can be done now; none for a key that is not the widget's own.
QAction* action_of(const QWidget& widget, const QKeyEvent& event);

/// Claims the keys of a widget's actions while it has the focus, so that a window that gives the same key to
/// a command of its own does not get it. For QWidget::event(); true where the event is dealt with.
bool claims_key(const QWidget& widget, QEvent& event);
/// The same of keys that a widget answers without an action, as far as neither Ctrl, Alt nor Meta is held.
bool claims_key(QEvent& event, std::initializer_list<Qt::Key> keys);

}  // namespace weave::studio
