// SPDX-License-Identifier: MIT
#include "cli/failure.hpp"

#include <fmt/format.h>

#include <csignal>
#include <new>

#include "mc/base.hpp"

namespace mc::cli {

std::optional<Failure> attempt(const std::function<void()>& work) {
  try {
    work();
    return std::nullopt;
  } catch (const Error& e) {
    return Failure{static_cast<int>(e.kind()), e.lines()};
  } catch (const Cancelled&) {
    // Only a signal asks for it, and the signal ends the process a moment later.
    return Failure{128 + SIGINT, {}};
  } catch (const std::bad_alloc&) {
    return Failure{static_cast<int>(ErrorKind::limit),
                   {"out of memory: the run needs more than this machine gives; "
                    "try --region or --threads 1"}};
  } catch (const std::exception& e) {
    return Failure{static_cast<int>(ErrorKind::internal),
                   {fmt::format("internal fault: {}; please report it", e.what())}};
  } catch (...) {
    return Failure{static_cast<int>(ErrorKind::internal),
                   {"internal fault: unknown exception; please report it"}};
  }
}

}  // namespace mc::cli
