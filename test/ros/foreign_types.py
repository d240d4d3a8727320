# SPDX-License-Identifier: BSD-3-Clause
"""Classes of moveit_msgs 0.11, control_msgs and octomap_msgs for tests, made by genpy of their fields: none of these need be installed."""
import hashlib

import genpy.dynamic
import roslib.message

FIELDS = {
    'object_recognition_msgs/ObjectType': 'string key\nstring db',
    'octomap_msgs/Octomap': 'Header header\nbool binary\nstring id\nfloat64 resolution\nint8[] data',
    'octomap_msgs/OctomapWithPose': 'Header header\ngeometry_msgs/Pose origin\noctomap_msgs/Octomap octomap',
    'moveit_msgs/CollisionObject': '''Header header
geometry_msgs/Pose pose
string id
object_recognition_msgs/ObjectType type
shape_msgs/SolidPrimitive[] primitives
geometry_msgs/Pose[] primitive_poses
shape_msgs/Mesh[] meshes
geometry_msgs/Pose[] mesh_poses
shape_msgs/Plane[] planes
geometry_msgs/Pose[] plane_poses
string[] subframe_names
geometry_msgs/Pose[] subframe_poses
byte ADD=0
byte REMOVE=1
byte APPEND=2
byte MOVE=3
byte operation''',
    'moveit_msgs/AttachedCollisionObject': '''string link_name
moveit_msgs/CollisionObject object
string[] touch_links
trajectory_msgs/JointTrajectory detach_posture
float64 weight''',
    'moveit_msgs/RobotState': '''sensor_msgs/JointState joint_state
sensor_msgs/MultiDOFJointState multi_dof_joint_state
moveit_msgs/AttachedCollisionObject[] attached_collision_objects
bool is_diff''',
    'moveit_msgs/AllowedCollisionEntry': 'bool[] enabled',
    'moveit_msgs/AllowedCollisionMatrix': '''string[] entry_names
moveit_msgs/AllowedCollisionEntry[] entry_values
string[] default_entry_names
bool[] default_entry_values''',
    'moveit_msgs/LinkPadding': 'string link_name\nfloat64 padding',
    'moveit_msgs/LinkScale': 'string link_name\nfloat64 scale',
    'moveit_msgs/ObjectColor': 'string id\nstd_msgs/ColorRGBA color',
    'moveit_msgs/PlanningSceneWorld': '''moveit_msgs/CollisionObject[] collision_objects
octomap_msgs/OctomapWithPose octomap''',
    'moveit_msgs/PlanningScene': '''string name
moveit_msgs/RobotState robot_state
string robot_model_name
geometry_msgs/TransformStamped[] fixed_frame_transforms
moveit_msgs/AllowedCollisionMatrix allowed_collision_matrix
moveit_msgs/LinkPadding[] link_padding
moveit_msgs/LinkScale[] link_scale
moveit_msgs/ObjectColor[] object_colors
moveit_msgs/PlanningSceneWorld world
bool is_diff''',
    'moveit_msgs/RobotTrajectory': '''trajectory_msgs/JointTrajectory joint_trajectory
trajectory_msgs/MultiDOFJointTrajectory multi_dof_joint_trajectory''',
    'moveit_msgs/DisplayTrajectory': '''string model_id
moveit_msgs/RobotTrajectory[] trajectory
moveit_msgs/RobotState trajectory_start''',
    'moveit_msgs/ContactInformation': '''Header header
geometry_msgs/Point position
geometry_msgs/Vector3 normal
float64 depth
string contact_body_1
uint32 body_type_1
string contact_body_2
uint32 body_type_2
uint32 ROBOT_LINK=0
uint32 WORLD_OBJECT=1
uint32 ROBOT_ATTACHED=2''',
    'moveit_msgs/PlanningSceneComponents': '\n'.join(
        ['uint32 %s=%d' % (name, 1 << i) for i, name in enumerate((
            'SCENE_SETTINGS', 'ROBOT_STATE', 'ROBOT_STATE_ATTACHED_OBJECTS', 'WORLD_OBJECT_NAMES',
            'WORLD_OBJECT_GEOMETRY', 'OCTOMAP', 'TRANSFORMS', 'ALLOWED_COLLISION_MATRIX', 'LINK_PADDING_AND_SCALING',
            'OBJECT_COLORS'))] + ['uint32 components']),
    'moveit_msgs/GetPlanningSceneRequest': 'moveit_msgs/PlanningSceneComponents components',
    'moveit_msgs/GetPlanningSceneResponse': 'moveit_msgs/PlanningScene scene',
    'control_msgs/JointTolerance': 'string name\nfloat64 position\nfloat64 velocity\nfloat64 acceleration',
    'control_msgs/FollowJointTrajectoryGoal': '''trajectory_msgs/JointTrajectory trajectory
control_msgs/JointTolerance[] path_tolerance
control_msgs/JointTolerance[] goal_tolerance
duration goal_time_tolerance''',
    'control_msgs/FollowJointTrajectoryResult': '\n'.join(
        ['int32 error_code'] + ['int32 %s = %d' % (name, -i) for i, name in enumerate((
            'SUCCESSFUL', 'INVALID_GOAL', 'INVALID_JOINTS', 'OLD_HEADER_TIMESTAMP', 'PATH_TOLERANCE_VIOLATED',
            'GOAL_TOLERANCE_VIOLATED'))] + ['string error_string']),
    'control_msgs/FollowJointTrajectoryFeedback': '\n'.join(
        ['Header header', 'string[] joint_names'] + ['trajectory_msgs/JointTrajectoryPoint ' + name for name in ('desired', 'actual', 'error')]),
    **{'control_msgs/FollowJointTrajectoryAction' + part: '''Header header
actionlib_msgs/%s
control_msgs/FollowJointTrajectory%s %s''' % (head, part, part.lower()) for part, head in (
        ('Goal', 'GoalID goal_id'), ('Result', 'GoalStatus status'), ('Feedback', 'GoalStatus status'))},
    'control_msgs/FollowJointTrajectoryAction': '\n'.join(
        'control_msgs/FollowJointTrajectoryAction%s action_%s' % (part, part.lower()) for part in ('Goal', 'Result', 'Feedback')),
}


def _parts(name):
    """The types of a type's fields, without arrays."""
    for line in FIELDS[name].splitlines():
        kind = line.split()[0].split('[')[0]
        kind = 'std_msgs/Header' if kind == 'Header' else kind
        if '/' in kind:
            yield kind


def _definition(name):
    """With all that it is made of, as in a bag file; what is installed is taken from there."""
    line = '=' * 80
    sections, waiting = {}, list(_parts(name))
    while waiting:
        kind = waiting.pop()
        if kind in sections:
            continue
        if kind in FIELDS:
            sections[kind] = FIELDS[kind]
            waiting += _parts(kind)
            continue
        first, *others = roslib.message.get_message_class(kind)._full_text.split(line + '\n')
        sections[kind] = first
        for other in others:
            head, _, text = other.partition('\n')
            sections.setdefault(head.split()[1], text)
    return FIELDS[name] + '\n' + ''.join('%s\nMSG: %s\n%s\n' % (line, kind, text) for kind, text in sections.items())


def message(name):
    """The class of a message, and those of its parts."""
    classes = genpy.dynamic.generate_dynamic(name, _definition(name))
    return classes[name], {kind.split('/')[1]: made for kind, made in classes.items()}


PlanningScene, PARTS = message('moveit_msgs/PlanningScene')
DisplayTrajectory, _ = message('moveit_msgs/DisplayTrajectory')
RobotTrajectory, _ = message('moveit_msgs/RobotTrajectory')
ContactInformation, _ = message('moveit_msgs/ContactInformation')
CollisionObject, AttachedCollisionObject = PARTS['CollisionObject'], PARTS['AttachedCollisionObject']
LinkPadding, LinkScale, AllowedCollisionEntry = PARTS['LinkPadding'], PARTS['LinkScale'], PARTS['AllowedCollisionEntry']


class GetPlanningScene:
    """The service, for rospy.Service."""
    _type = 'moveit_msgs/GetPlanningScene'
    _request_class, _ = message('moveit_msgs/GetPlanningSceneRequest')
    _response_class, _ = message('moveit_msgs/GetPlanningSceneResponse')
    # what gentools takes the sum of: the request's text, then the response's, parts by their own sums
    _md5sum = hashlib.md5(('%s components%s scene' % (message('moveit_msgs/PlanningSceneComponents')[0]._md5sum,
                                                      PlanningScene._md5sum)).encode()).hexdigest()
