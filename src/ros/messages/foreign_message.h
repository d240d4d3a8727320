/* SPDX-License-Identifier: BSD-3-Clause */
/** Messages of packages that need not be installed, as structs of ours: what roscpp has to know of them. */
#ifndef CURVE_PROXIMITY_ROS_FOREIGN_MESSAGE_H
#define CURVE_PROXIMITY_ROS_FOREIGN_MESSAGE_H

#include <ros/message_traits.h>
#include <ros/serialization.h>

#include <boost/preprocessor/seq/for_each.hpp>
#include <boost/preprocessor/variadic/to_seq.hpp>

/** Outside all namespaces. The further arguments: all members in the order of the message's definition. */
#define CURVE_PROXIMITY_FOREIGN_SERIALIZER(Type, ...)                                                 \
  namespace ros::serialization {                                                                      \
  template <>                                                                                         \
  struct Serializer<Type> {                                                                           \
    template <typename Stream, typename Message>                                                      \
    static void allInOne(Stream &stream, Message message){                                            \
        BOOST_PP_SEQ_FOR_EACH(CURVE_PROXIMITY_FOREIGN_MEMBER, ,                                       \
                              BOOST_PP_VARIADIC_TO_SEQ(__VA_ARGS__))} ROS_DECLARE_ALLINONE_SERIALIZER \
  };                                                                                                  \
  }
#define CURVE_PROXIMITY_FOREIGN_MEMBER(r, unused, member) stream.next(message.member);

/** Outside all namespaces. Name: "package/Message"; Md5 and Text: of its definition. */
#define CURVE_PROXIMITY_FOREIGN_TRAITS(Type, Name, Md5, Text) \
  namespace ros::message_traits {                             \
  template <>                                                 \
  struct IsMessage<Type> : TrueType {};                       \
  template <>                                                 \
  struct IsMessage<const Type> : TrueType {};                 \
  CURVE_PROXIMITY_FOREIGN_TEXT(MD5Sum, Type, Md5)             \
  CURVE_PROXIMITY_FOREIGN_TEXT(DataType, Type, Name)          \
  CURVE_PROXIMITY_FOREIGN_TEXT(Definition, Type, Text)        \
  }
#define CURVE_PROXIMITY_FOREIGN_TEXT(Trait, Type, Text) \
  template <>                                           \
  struct Trait<Type> {                                  \
    static const char *value() {                        \
      return Text;                                      \
    }                                                   \
    static const char *value(const Type &) {            \
      return Text;                                      \
    }                                                   \
  };

#endif
