"""A quadruped of the Go2's size as a URDF, made up: what a newcomer brings."""

LEG = """
<link name="{n}_hip"><inertial><origin xyz="0 {s}0.05 0"/><mass value="0.6"/>
  <inertia ixx="8e-4" iyy="8e-4" izz="8e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="{n}_hip_joint" type="revolute"><parent link="base"/><child link="{n}_hip"/><origin xyz="{x} {y} 0"/><axis xyz="1 0 0"/>
  <limit lower="-0.8" upper="0.8" effort="23" velocity="20"/></joint>
<link name="{n}_thigh"><inertial><origin xyz="0 0 -0.1"/><mass value="1.1"/>
  <inertia ixx="5e-3" iyy="5e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><origin xyz="0 0 -0.1"/><geometry><box size="0.03 0.03 0.2"/></geometry></collision></link>
<joint name="{n}_thigh_joint" type="revolute"><parent link="{n}_hip"/><child link="{n}_thigh"/>
  <origin xyz="0 {s}0.09 0"/><axis xyz="0 1 0"/><limit lower="-1.5" upper="3.4" effort="23" velocity="20"/></joint>
<link name="{n}_calf"><inertial><origin xyz="0 0 -0.1"/><mass value="0.25"/>
  <inertia ixx="1e-3" iyy="1e-3" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="{n}_calf_joint" type="revolute"><parent link="{n}_thigh"/><child link="{n}_calf"/><origin xyz="0 0 -0.21"/><axis xyz="0 1 0"/>
  <limit lower="-2.7" upper="-0.85" effort="45" velocity="15"/></joint>
<link name="{n}_foot"/>
<joint name="{n}_foot_joint" type="fixed"><parent link="{n}_calf"/><child link="{n}_foot"/><origin xyz="0 0 -0.21"/></joint>
"""
"""A leg of a quadruped of the Go2's size, made up."""


def urdf() -> str:
    legs = "".join(
        LEG.format(n=name, x=x, y=y, s="" if y > 0 else "-")
        for name, x, y in (("FL", 0.19, 0.05), ("FR", 0.19, -0.05), ("RL", -0.19, 0.05), ("RR", -0.19, -0.05))
    )
    base = (
        '<link name="base"><inertial><mass value="7"/><inertia ixx="0.03" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial>'
        '<visual><geometry><mesh filename="package://go2/meshes/base.dae"/></geometry></visual>'
        '<collision><geometry><box size="0.37 0.09 0.11"/></geometry></collision></link>'
    )
    return f'<robot name="go2">{base}{legs}</robot>'
