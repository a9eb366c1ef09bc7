/// \file
/// Which vector instructions the kernels may use. Each kernel has a scalar path as well, for other
/// processors; both give the same bits. The CMake option FAST_EDI_SCALAR builds the scalar paths on
/// every processor, so that tests reach them.
#pragma once

#if defined(__SSE2__) && !defined(FAST_EDI_SCALAR)
#define FAST_EDI_SSE2 1
#else
#define FAST_EDI_SSE2 0
#endif
