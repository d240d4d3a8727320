/* SPDX-License-Identifier: BSD-3-Clause */
/** A service of roscpp that sees a request before it is made: its bytes, its connection, when it came; and whether its
 *  client is still there. */
#ifndef CURVE_PROXIMITY_ROS_SERVICE_H
#define CURVE_PROXIMITY_ROS_SERVICE_H

#include <ros/advertise_service_options.h>
#include <ros/callback_queue_interface.h>
#include <ros/node_handle.h>
#include <ros/service_callback_helper.h>
#include <ros/service_server.h>
#include <ros/service_traits.h>

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

#include "transport/checked_stream.h"
#include "transport/threaded_queue.h"

namespace curve_proximity {

/** What is known of a call beside its request. */
struct Call {
  std::string client; /**< who shares one place in the order: the connection, or its node where each call has its own */
  std::size_t bytes = 0; /**< of the request on the wire */
  std::chrono::steady_clock::time_point arrival = std::chrono::steady_clock::now();
  bool in_process = false;      /**< by a thread of the caller, not one of the pool */
  std::function<bool()> isGone; /**< has its client gone? By the thread of the call; empty: nobody can say */
};

/** A callback of a service, at work. roscpp looks whether the client of a callback has gone when it is called, not while
 *  it works: so it is called once more, now and then. If the client is there, this comes to ServiceHelper, which throws
 *  `Asked`. */
class RunningCall : public ros::CallbackInterface {
 public:
  struct Asked {};

  explicit RunningCall(ros::CallbackInterfacePtr callback) : callback_(std::move(callback)) {}

  CallResult call() override {
    ofThread() = this;
    next_ = std::chrono::steady_clock::now() + PERIOD;
    const CallResult result = callback_->call();
    ofThread() = nullptr;
    return result;
  }

  /** The one at work in this thread; null: none. */
  static RunningCall *&ofThread() {
    static thread_local RunningCall *running = nullptr;
    return running;
  }

  bool isAsked() const {
    return asked_;
  }

  /** Has the client closed its connection? Once true it stays so. Only the thread that works can ask: in another one
   *  the call would be answered again. */
  bool isGone() {
    if (ofThread() != this) return false;
    const auto now = std::chrono::steady_clock::now();
    if (gone_ || now < next_) return gone_;
    next_ = now + PERIOD;
    asked_ = true;
    try {
      gone_ = callback_->call() == Invalid;
    } catch (const Asked &) {
    }
    asked_ = false;
    return gone_;
  }

 private:
  static constexpr std::chrono::milliseconds PERIOD{10};

  const ros::CallbackInterfacePtr callback_;
  std::chrono::steady_clock::time_point next_; /* when to ask again: it throws, which takes longer than a small query */
  bool asked_ = false, gone_ = false;
};

/** The queue of services. */
class ServiceQueue : public ThreadedQueue {
 public:
  using ThreadedQueue::ThreadedQueue;

  void addCallback(const ros::CallbackInterfacePtr &callback, std::uint64_t removal_id = 0) override {
    ThreadedQueue::addCallback(boost::make_shared<RunningCall>(callback), removal_id);
  }
};

/** handler(call, read, response): `read(request)` makes the request of its bytes. What handler throws fails the call;
 *  roscpp tells the client what(). */
template <class Service>
class ServiceHelper : public ros::ServiceCallbackHelper {
 public:
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  using Read = std::function<void(Request &)>;
  using Handler = std::function<void(const Call &call, const Read &read, Response &response)>;

  explicit ServiceHelper(Handler handler) : handler_(std::move(handler)) {}

  bool call(ros::ServiceCallbackHelperCallParams &params) override {
    Call call;
    if (RunningCall *running = RunningCall::ofThread()) {
      if (running->isAsked()) throw RunningCall::Asked();
      call.isGone = [running] { return running->isGone(); };
    }
    call.bytes = params.request.num_bytes;
    call.client = clientOf(params.connection_header.get());
    Response response;
    handler_(
        call,
        [&](Request &request) {
          CheckedStream stream(params.request.buf.get(), params.request.num_bytes);
          stream.next(request);
        },
        response);
    params.response = ros::serialization::serializeServiceResponse(true, response);
    return true;
  }

 private:
  static std::string clientOf(const ros::M_string *header) {
    if (!header) return "";
    const auto persistent = header->find("persistent");
    if (persistent != header->end() && persistent->second != "0")
      return std::to_string(reinterpret_cast<std::uintptr_t>(header));
    const auto caller = header->find("callerid");
    return caller == header->end() ? "" : caller->second;
  }

  const Handler handler_;
};

/** handle: its callback queue runs the calls. */
template <class Service>
ros::ServiceServer advertise(ros::NodeHandle &handle, const std::string &name,
                             typename ServiceHelper<Service>::Handler handler) {
  ros::AdvertiseServiceOptions options;
  options.service = name;
  options.md5sum = ros::service_traits::md5sum<Service>();
  options.datatype = ros::service_traits::datatype<Service>();
  options.req_datatype = ros::message_traits::datatype<typename Service::Request>();
  options.res_datatype = ros::message_traits::datatype<typename Service::Response>();
  options.helper = boost::make_shared<ServiceHelper<Service>>(std::move(handler));
  return handle.advertiseService(options);
}

} // namespace curve_proximity
#endif
