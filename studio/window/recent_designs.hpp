#pragma once

#include <weave/core/json.hpp>

#include <QImage>
#include <QString>
#include <QStringList>

/// The designs that this person had open of late: where they are, a picture of each, and how it was looked at last. None of this is
/// in the design's file: a look is no change of it, and what is approved is the same whoever looked at it.
namespace weave::studio::recent_designs {

/// Latest first.
QStringList paths();
/// It was opened or saved just now.
void note(const QString& path);
/// Takes it from the list, with all that is kept of it.
void forget(const QString& path);

/// How a design was looked at; of one that is not in the list nothing is kept.
void keep_view(const QString& path, const Json& view);
/// An empty object where there is none, or none that can be read.
Json view(const QString& path);

/// Writes the picture of a design into the cache, and takes away those that no design of the list has; for another thread than the
/// window's. A cache that cannot be written is no trouble of anybody's.
void keep_picture(const QString& path, const QImage& picture);
/// Null where there is none.
QImage picture(const QString& path);

}  // namespace weave::studio::recent_designs
