# SPDX-License-Identifier: GPL-3.0-or-later
"""The live widget of an exploration: the picture, buttons for time, a scheme for each lane, a slider for each parameter."""
from __future__ import annotations

from ._library import GeomintError

WIDTH, HEIGHT = 800, 450
FRAME = 100  # milliseconds between two pictures
SECONDS = 12  # of the scene's own span of time


class Panel:
    """`box` is shown. The buttons, menus and sliders call the verbs of the exploration, and nothing else."""

    def __init__(self, lab, widgets):
        self.lab, self.widgets = lab, widgets
        self.quiet = False  # values are shown, not set
        view = lab.view
        self.pace = abs(view["ahead"] - view["t"]) * FRAME / 1000 / SECONDS
        self.image = widgets.Image(format="png", width=WIDTH, height=HEIGHT)
        self.note = widgets.Label()
        self.play = widgets.Play(interval=FRAME, min=0, max=10**9)
        self.play.observe(self.tick, "value")
        buttons = [("step-backward", "one step back", lab.back), ("step-forward", "one step", lab.forward),
                   ("exchange", "time the other way", lab.reverse), ("refresh", "restart", lab.restart),
                   ("undo", "undo the last change", lab.undo), ("code-fork", "fork the first lane", self.fork)]
        self.buttons = {}
        for icon, tooltip, verb in buttons:
            button = self.buttons[icon] = widgets.Button(icon=icon, tooltip=tooltip, layout=widgets.Layout(width="42px"))
            button.on_click(lambda _, verb=verb: self.act(verb))
        names = [scheme["scheme"] for scheme in lab.schemes]
        self.other = widgets.Dropdown(options=names, description="fork with", value=names[0])
        self.lanes = widgets.VBox()
        self.names = names
        self.sliders = {}
        for row in view["parameters"]:
            if row["position"] is not None:
                slider = self.sliders[row["key"]] = widgets.FloatSlider(
                    min=0, max=1, step=1e-3, readout=False, description=row["key"])
                slider.observe(lambda change, key=row["key"]: self.act(lab.slide, key, change["new"]), "value")
        self.values = {key: widgets.Label() for key in self.sliders}
        rows = [widgets.HBox([slider, self.values[key]]) for key, slider in self.sliders.items()]
        side = widgets.VBox([self.lanes, self.other, *rows])
        time = widgets.HBox([self.play, *self.buttons.values(), self.note])
        self.box = widgets.HBox([widgets.VBox([self.image, time]), side])
        self.show()

    def fork(self):
        self.lab.fork(self.other.value)

    def tick(self, change):
        if change["new"] > 0:
            view = self.lab.view
            self.act(self.lab.advance, view["t"] + (-self.pace if view["backwards"] else self.pace))

    def act(self, verb, *arguments):
        """Calls a verb; what it refuses is shown."""
        if self.quiet:
            return
        try:
            verb(*arguments)
            self.show()
        except GeomintError as error:
            self.show(str(error))

    def show(self, sentence=""):
        view = self.lab.view
        failed = [lane["message"] for lane in view["lanes"] if lane["message"]]
        self.note.value = sentence or (failed[0] if failed else f"t = {view['t']:.5g}")
        self.image.value = self.lab.picture(WIDTH, HEIGHT).png
        self.quiet = True
        try:
            if len(self.lanes.children) != len(view["lanes"]):
                self.lanes.children = [self.menu(i) for i in range(len(view["lanes"]))]
            for menu, lane in zip(self.lanes.children, view["lanes"]):
                menu.options = self.names if lane["scheme"] in self.names else [*self.names, lane["scheme"]]
                menu.value = lane["scheme"]
            for row in view["parameters"]:
                if row["key"] in self.sliders:
                    self.sliders[row["key"]].value = row["position"]
                    self.values[row["key"]].value = row["value"]
        finally:
            self.quiet = False

    def menu(self, lane):
        menu = self.widgets.Dropdown(options=self.names, description=f"lane {lane}")
        menu.observe(lambda change: self.act(self.lab.switch, change["new"], lane), "value")
        return menu
