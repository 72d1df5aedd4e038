// What values must be to each other: references, directions, rectangles, listeners. Private to the room.
#pragma once

#include "configs/loader/report.h"
#include "configs/model/show.h"

namespace cupola::loader {

/// Runs every check. One whose subject holds a value that is refused already says nothing.
void cross_check(const model::Show& show, Report& report);

} // namespace cupola::loader
