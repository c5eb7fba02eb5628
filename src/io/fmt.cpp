// fmt's functions, compiled once here. Header-only use would compile them in every file, and fmt's
// shared library would be a dependency of every host.
#include <fmt/format-inl.h>

FMT_BEGIN_NAMESPACE
namespace detail {

template auto decimal_point_impl(locale_ref) -> char;
template auto thousands_sep_impl<char>(locale_ref) -> thousands_sep_result<char>;

}  // namespace detail
FMT_END_NAMESPACE
