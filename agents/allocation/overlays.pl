% Overlays of robots and tasks on the page; facts overlay/4, see doc/page.md.

overlay('task reserved', label, log(reserved(Robot, _, Task)), Robot-Task).
overlay('task reserved', label, log(released(Robot, _, _)), Robot-none).
overlay('task executed last', label, log(executed(Robot, _, Task)), Robot-Task).
