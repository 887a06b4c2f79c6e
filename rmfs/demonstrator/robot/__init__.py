"""The software that runs on a robot's computer.

The client library (`protocol`, `channel`, `client`) and the control program (`order`, `program`,
`pid`, `create2`, `tags`) need nothing but the standard library, so this folder can be copied to a
small computer as it is. `lines` needs OpenCV and NumPy; `__main__` needs pyserial, too.
"""
