#pragma once

#include <QDir>
#include <QString>

namespace weave::studio::test {

/// Where tests that are run by hand leave a picture for a person to look at: in the folder that WEAVE_SCREENS names, or else in one of
/// the system's temporary folder.
inline QString screen_file(const QString& name) {
    QDir folder(qEnvironmentVariable("WEAVE_SCREENS", QDir::temp().filePath("weave-screens")));
    folder.mkpath(".");
    return folder.filePath(name);
}

}  // namespace weave::studio::test
