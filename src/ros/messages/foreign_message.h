/* SPDX-License-Identifier: BSD-3-Clause */
/** Messages of packages that need not be installed, as structs of ours: what roscpp has to know of them. */
#ifndef CURVE_PROXIMITY_ROS_FOREIGN_MESSAGE_H
#define CURVE_PROXIMITY_ROS_FOREIGN_MESSAGE_H

#include <ros/message_traits.h>
#include <ros/serialization.h>

/** Outside all namespaces. The further arguments: `stream.next(message.MEMBER);` for each member, in the order of the
 *  message's definition. */
#define CURVE_PROXIMITY_FOREIGN_SERIALIZER(Type, ...)                                                  \
  namespace ros::serialization {                                                                       \
  template <>                                                                                          \
  struct Serializer<Type> {                                                                            \
    template <typename Stream, typename Message>                                                       \
    static void allInOne(Stream &stream, Message message){__VA_ARGS__} ROS_DECLARE_ALLINONE_SERIALIZER \
  };                                                                                                   \
  }

/** Outside all namespaces. Name: "package/Message"; Md5 and Text: of its definition. */
#define CURVE_PROXIMITY_FOREIGN_TRAITS(Type, Name, Md5, Text) \
  namespace ros::message_traits {                             \
  template <>                                                 \
  struct IsMessage<Type> : TrueType {};                       \
  template <>                                                 \
  struct IsMessage<const Type> : TrueType {};                 \
  template <>                                                 \
  struct MD5Sum<Type> {                                       \
    static const char *value() {                              \
      return Md5;                                             \
    }                                                         \
    static const char *value(const Type &) {                  \
      return Md5;                                             \
    }                                                         \
  };                                                          \
  template <>                                                 \
  struct DataType<Type> {                                     \
    static const char *value() {                              \
      return Name;                                            \
    }                                                         \
    static const char *value(const Type &) {                  \
      return Name;                                            \
    }                                                         \
  };                                                          \
  template <>                                                 \
  struct Definition<Type> {                                   \
    static const char *value() {                              \
      return Text;                                            \
    }                                                         \
    static const char *value(const Type &) {                  \
      return Text;                                            \
    }                                                         \
  };                                                          \
  }

#endif
