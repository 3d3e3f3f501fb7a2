#include <studio/editors/own_keys.hpp>

#include <algorithm>

namespace weave::studio {

QAction* action_of(const QWidget& widget, const QKeyEvent& event) {
    const auto modifiers = event.modifiers() & ~Qt::KeypadModifier;
    const QKeySequence keys(QKeyCombination(modifiers, static_cast<Qt::Key>(event.key())));
    // A plus sign needs Shift on most keyboards, and none on the number pad.
    const QKeySequence unshifted(
        QKeyCombination(modifiers & ~Qt::ShiftModifier, static_cast<Qt::Key>(event.key())));
    const bool sign = event.key() == Qt::Key_Plus;
    for (QAction* action : widget.actions()) {
        if (!action->isEnabled()) continue;
        if (action->shortcuts().contains(keys) || (sign && action->shortcuts().contains(unshifted)))
            return action;
    }
    return nullptr;
}

bool claims_key(const QWidget& widget, QEvent& event) {
    if (event.type() != QEvent::ShortcutOverride) return false;
    if (action_of(widget, static_cast<QKeyEvent&>(event)) == nullptr) return false;
    event.accept();
    return true;
}

bool claims_key(QEvent& event, std::initializer_list<Qt::Key> keys) {
    if (event.type() != QEvent::ShortcutOverride) return false;
    const auto& key = static_cast<const QKeyEvent&>(event);
    if (key.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) return false;
    if (std::ranges::find(keys, key.key()) == keys.end()) return false;
    event.accept();
    return true;
}

}  // namespace weave::studio
