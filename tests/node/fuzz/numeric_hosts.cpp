// SPDX-License-Identifier: Apache-2.0
// No name is looked up by a fuzzer, whatever the text: this stands before the C library's.
#include <dlfcn.h>
#include <netdb.h>

extern "C" int getaddrinfo(const char* node, const char* service, const addrinfo* hints, addrinfo** found) {
  using Real = int (*)(const char*, const char*, const addrinfo*, addrinfo**);
  static const auto real = reinterpret_cast<Real>(::dlsym(RTLD_NEXT, "getaddrinfo"));
  addrinfo wanted = hints != nullptr ? *hints : addrinfo{};
  wanted.ai_flags |= AI_NUMERICHOST;
  return real(node, service, &wanted, found);
}
