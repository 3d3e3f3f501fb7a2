#pragma once

#include <QString>

namespace weave::studio {

/// A tooltip that shows foreign words as they are: Qt takes what looks like HTML for it. Long ones wrap.
inline QString plain_tip(const QString& words) {
    return words.isEmpty() ? QString() : "<qt>" + words.toHtmlEscaped().replace('\n', "<br>") + "</qt>";
}

}  // namespace weave::studio
