#pragma once

#include <QLabel>

namespace weave::studio {

/// A label that shows words as they are, over as many lines as they take.
inline QLabel* plain_label(const char* name) {
    auto* label = new QLabel;
    label->setObjectName(name);
    label->setWordWrap(true);
    label->setTextFormat(Qt::PlainText);
    return label;
}

}  // namespace weave::studio
