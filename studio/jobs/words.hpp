#pragma once

#include <QString>

#include <string>

namespace weave::studio {

/// The library's words, and names, as the window shows them.
inline QString words(const std::string& text) {
    return QString::fromStdString(text);
}

}  // namespace weave::studio
