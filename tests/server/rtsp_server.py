"""An RTSP server that shows one JPEG picture again and again: rtsp_server.py PICTURE PORT."""

import sys

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstRtspServer", "1.0")
from gi.repository import GLib, Gst, GstRtspServer  # noqa: E402

picture, port = sys.argv[1:]
Gst.init(None)
factory = GstRtspServer.RTSPMediaFactory()
factory.set_shared(True)
factory.set_launch(
    f"( multifilesrc location={picture} loop=true caps=image/jpeg,framerate=20/1 ! jpegdec"
    " ! videoconvert ! videoscale ! video/x-raw,width=640,height=480 ! jpegenc ! rtpjpegpay name=pay0 )"
)
server = GstRtspServer.RTSPServer()
server.set_address("127.0.0.1")
server.set_service(port)
server.get_mount_points().add_factory("/head", factory)
server.attach(None)
print(f"rtsp://127.0.0.1:{server.get_bound_port()}/head", flush=True)
GLib.MainLoop().run()
