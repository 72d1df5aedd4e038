// From a show's outputs to running ones: test, and open beside those that run.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "configs/model/problem.h"
#include "configs/model/show.h"
#include "renderer/outputs/context.h"
#include "renderer/outputs/output.h"

namespace cupola::outputs {

/// Running outputs by name, with what they were opened for.
struct Running {
  model::Output wanted;
  std::shared_ptr<Output> output;
};
using RunningOutputs = std::map<std::string, Running>;

using WantedOutputs = std::map<std::string, model::Output>;

/// The part of an output that opening it depends on is the same: its kind and settings, and its size.
[[nodiscard]] bool opens_alike(const model::Output& a, const model::Output& b);

/// Some output needs a window, or takes one where there is a display.
[[nodiscard]] bool wants_windows(const WantedOutputs& wanted);
/// Some output cannot do without a window.
[[nodiscard]] bool needs_windows(const WantedOutputs& wanted);

/// Main thread. What would keep the outputs from being opened, as far as can be told without opening them.
[[nodiscard]] model::Problems test_outputs(const WantedOutputs& wanted, Context& context);

/// Main thread. Opens what `wanted` has and `running` has not, or has otherwise; takes over the rest. Nothing
/// that runs is touched; what is no longer wanted closes when its last reference goes (render thread).
/// Fails with all problems, and then has opened nothing.
[[nodiscard]] model::Result<RunningOutputs>
open_outputs(const WantedOutputs& wanted, const RunningOutputs& running, MainThread& main, Context& context);

} // namespace cupola::outputs
