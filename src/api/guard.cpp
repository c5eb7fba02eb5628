#include "api/guard.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>

namespace grainlaw::core::api {

void MessageBuffer::write(std::string_view message) const noexcept {
  if (text == nullptr || size == 0) return;
  const std::size_t length = std::min(message.size(), size - 1);
  std::memcpy(text, message.data(), length);
  text[length] = '\0';
}

grainlaw_status translate_exception(const MessageBuffer& message) noexcept {
  try {
    throw;
  } catch (const Error& error) {
    message.write(error.what());
    return error.status;
  } catch (const std::bad_alloc&) {
    message.write(grainlaw_status_text(GRAINLAW_OUT_OF_MEMORY));
    return GRAINLAW_OUT_OF_MEMORY;
  } catch (const std::exception& error) {
    message.write(error.what());
  } catch (...) {
    message.write(grainlaw_status_text(GRAINLAW_INTERNAL_FAULT));
  }
  return GRAINLAW_INTERNAL_FAULT;
}

}  // namespace grainlaw::core::api
