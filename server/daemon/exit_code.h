// How cupolad ends; systemd/cupolad.service goes by it.
#pragma once

namespace cupola::daemon {

enum ExitCode : int {
  exit_done = 0,         ///< ended as asked; --check: the show is valid
  exit_show = 1,         ///< the show has problems; they were printed
  exit_usage = 2,        ///< wrong arguments, or the show file cannot be read
  exit_start = 3,        ///< an output, OpenGL or a listener could not be opened
  exit_context_lost = 4, ///< the driver has reset the GPU, or the display is gone: start again
};

} // namespace cupola::daemon
