// SPDX-License-Identifier: Apache-2.0
// Rounds over ZeroMQ with CURVE.
#include "mesh.hpp"

#ifdef GARRISON_HAVE_ZMQ
#include <zmq.h>

#include <cstdlib>

namespace garrison::node::test {

namespace {

/// A ROUTER to hear, and a DEALER to every neighbour.
class Curve final : public Mesh {
 public:
  Curve(MeshPlan& plan, int own) : plan_(plan), own_(own) {}
  ~Curve() override {
    for (void* socket : all_) ::zmq_close(socket);
    if (context_ != nullptr) ::zmq_ctx_term(context_);
  }
  bool open() override {
    context_ = ::zmq_ctx_new();
    hears_ = made(ZMQ_ROUTER);
    const int server = 1;
    set(hears_, ZMQ_CURVE_SERVER, &server, sizeof server);
    set(hears_, ZMQ_CURVE_SECRETKEY, secret(own_), 41);
    set(hears_, ZMQ_RCVTIMEO, &kPatienceMs, sizeof kPatienceMs);
    if (::zmq_bind(hears_, place(own_).c_str()) != 0) return false;
    for (const int j : plan_.neighbours(own_)) {
      void* socket = made(ZMQ_DEALER);
      set(socket, ZMQ_CURVE_SERVERKEY, plan_.open[static_cast<std::size_t>(j)].data(), 41);
      set(socket, ZMQ_CURVE_PUBLICKEY, plan_.open[static_cast<std::size_t>(own_)].data(), 41);
      set(socket, ZMQ_CURVE_SECRETKEY, secret(own_), 41);
      if (::zmq_connect(socket, place(j).c_str()) != 0) return false;
      tells_.push_back(socket);
    }
    return true;
  }
  void send(int round) override {
    std::array<std::byte, kBytes> bytes{};
    wire::store(bytes.data(), static_cast<std::uint32_t>(round));
    for (void* socket : tells_) ::zmq_send(socket, bytes.data(), bytes.size(), 0);
  }
  int receive() override {
    std::array<std::byte, 256> bytes{};
    if (::zmq_recv(hears_, bytes.data(), bytes.size(), 0) < 0) return -1;  // who
    return ::zmq_recv(hears_, bytes.data(), bytes.size(), 0) < 0
               ? -1
               : static_cast<int>(wire::load<std::uint32_t>(bytes.data()));
  }

 private:
  void* made(int kind) {
    all_.push_back(::zmq_socket(context_, kind));
    const int none = 0;
    set(all_.back(), ZMQ_LINGER, &none, sizeof none);
    return all_.back();
  }
  static void set(void* socket, int option, const void* value, std::size_t size) {
    if (::zmq_setsockopt(socket, option, value, size) != 0) std::abort();
  }
  const char* secret(int who) const { return plan_.secret[static_cast<std::size_t>(who)].data(); }
  std::string place(int who) const {
    return "tcp://127.0.0.1:" + std::to_string(plan_.ports[static_cast<std::size_t>(2 * who + 1)]);
  }

  MeshPlan& plan_;
  int own_;
  void* context_ = nullptr;
  void* hears_ = nullptr;
  std::vector<void*> tells_, all_;
};

}  // namespace

bool curve_is_built() { return true; }
void add_curve_keys(MeshPlan& plan) {
  for (int i = 0; i < plan.nodes; ++i)
    ::zmq_curve_keypair(plan.open.emplace_back().data(), plan.secret.emplace_back().data());
}
std::unique_ptr<Mesh> curve_mesh(MeshPlan& plan, int own) { return std::make_unique<Curve>(plan, own); }

}  // namespace garrison::node::test
#else
namespace garrison::node::test {

bool curve_is_built() { return false; }
void add_curve_keys(MeshPlan&) {}
std::unique_ptr<Mesh> curve_mesh(MeshPlan&, int) { return nullptr; }

}  // namespace garrison::node::test
#endif
