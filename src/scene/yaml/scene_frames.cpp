/* SPDX-License-Identifier: BSD-3-Clause */
#include "scene_frames.h"

#include "bad_input.h"

namespace curve_proximity::yaml {
namespace {

std::string bare(const std::string &name) {
  return name.rfind('/', 0) == 0 ? name.substr(1) : name;
}

} // namespace

Frames::Frames(std::set<std::string> fixed, const std::vector<FrameTransform> &transforms, LinkPoses links,
               Warnings &warnings)
    : fixed_(std::move(fixed)), links_(std::move(links)) {
  fixed_.insert({"", "world"});
  for (const FrameTransform &transform : transforms) {
    const std::string child = bare(transform.child);

    /* a frame that stands in itself, unmoved, is how MoveIt writes down the fixed frame of the file */
    const bool is_identity = transform.pose.isApprox(Eigen::Isometry3d::Identity());
    if (is_identity && bare(transform.parent) == child) fixed_.insert(child);
    if (fixed_.count(child) == 0) {
      const auto [known, is_new] = transforms_.emplace(child, transform);
      const bool same = known->second.parent == transform.parent && known->second.pose.isApprox(transform.pose);
      if (!is_new && !same)
        warnings.leaveOut("fixed_frame_transforms: '" + child + "' comes twice; the second is ignored");
    } else if (!is_identity) {
      warnings.leaveOut("fixed_frame_transforms: '" + child + "' is the fixed frame; its transform is ignored");
    }
  }
}

bool Frames::isFixed(const std::string &name) const {
  return fixed_.count(bare(name)) > 0;
}

bool Frames::knows(const std::string &name) const {
  const std::string frame = bare(name);
  return isFixed(frame) || transforms_.count(frame) > 0 || links_.count(frame) > 0;
}

Eigen::Isometry3d Frames::find(const std::string &name) const {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  std::string frame = bare(name);

  /* from transform to transform; more steps than there are transforms go in a ring */
  for (std::size_t step = 0; step <= transforms_.size(); ++step) {
    if (isFixed(frame)) return pose;
    const auto transform = transforms_.find(frame);
    if (transform == transforms_.end()) {
      const auto link = links_.find(frame);
      if (link != links_.end()) return link->second * pose;
      throw BadInput("the frame '" + name + "' is not known" +
                     (frame == bare(name) ? "" : ": it leads to '" + frame + "', which is not") +
                     "; it is neither the fixed frame, nor in fixed_frame_transforms, nor a link of the robot");
    }
    pose = transform->second.pose * pose;
    frame = bare(transform->second.parent);
  }
  throw BadInput("the frame '" + name + "' stands in itself: fixed_frame_transforms go in a ring");
}

} // namespace curve_proximity::yaml
