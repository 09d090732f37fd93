// SPDX-License-Identifier: MIT
#include "cli/messages/failure.hpp"

#include <fmt/format.h>

#include <csignal>
#include <new>
#include <string_view>
#include <system_error>

#include "cli/messages/remedy.hpp"
#include "convert/watching_inputs.hpp"

namespace mc::cli {

namespace {

Failure out_of_memory() {
  return {static_cast<int>(ErrorKind::limit),
          {"out of memory: the run needs more than this machine gives; "
           "try --region or --threads 1"}};
}

Failure internal_fault(std::string_view what) {
  return {static_cast<int>(ErrorKind::internal),
          {fmt::format("internal fault: {}; please report it", what)}};
}

}  // namespace

Failure failure_of(const Error& error) {
  if (error.remedy() == Remedy::none) return {static_cast<int>(error.kind()), error.lines()};
  return {static_cast<int>(error.kind()), {with_remedy(error.what(), error.remedy())}};
}

std::optional<Failure> attempt(const std::function<void()>& work) {
  try {
    conversion::watching_inputs(work);
    return std::nullopt;
  } catch (const Error& e) {
    return failure_of(e);
  } catch (const Cancelled&) {
    // Only a signal asks for it, and the signal ends the process a moment later.
    return Failure{128 + SIGINT, {}};
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const std::system_error& e) {
    if (e.code() == std::errc::resource_unavailable_try_again) return out_of_memory();  // a thread
    return internal_fault(e.what());
  } catch (const std::exception& e) {
    return internal_fault(e.what());
  } catch (...) {
    return internal_fault("unknown exception");
  }
}

}  // namespace mc::cli
