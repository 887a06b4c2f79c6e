"""The software that runs on a robot's computer.

The client library (`protocol`, `channel`, `client`) and the control program (`order`, `program`,
`pid`, `create2`, `tags`) need only the standard library, so this folder can be copied unchanged to
a small computer. `lines` also needs OpenCV and NumPy; `__main__` needs these and pyserial.
"""
