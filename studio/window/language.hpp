#pragma once

#include <QLocale>
#include <QString>

namespace weave::studio {

/// From now on the studio's texts are those of this language, as far as there are any (`studio_de.qm` in `folder`); the others stay
/// English, of which the source has no plurals: they are a translation too.
void speak_language_of(const QLocale& locale, const QString& folder = ":/translations");

}  // namespace weave::studio
