#pragma once

#include <QString>
#include <QTextDocument>

namespace weave::studio {

/// Words as a tooltip shows them letter by letter: a block's name may look like markup, which tooltips would follow.
inline QString as_plain(const QString& words) {
    return Qt::mightBeRichText(words) ? "<p>" + words.toHtmlEscaped().replace('\n', "<br>") + "</p>" : words;
}

}  // namespace weave::studio
