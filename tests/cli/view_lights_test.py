#!/usr/bin/env python3
"""The lights of the page of `alhazen view` in a browser.

Usage: view_lights_test.py ALHAZEN [SCREENSHOT_FOLDER]

Skipped, with a message, without a browser: `scripts/setup --browser` installs one.
"""

from view_server import LIGHTS
from viewer_page import ViewerPage, run_tests


class ViewLights(ViewerPage):
    def test_lights_are_turned_off_and_undo_takes_back_what_was_chosen(self):
        self.scene.write_text(LIGHTS, encoding="utf-8")
        self.open(1300, 900)
        page = self.page
        first = self.picture()
        summary = "document.querySelector('#lights summary')"
        boxes = "[...document.querySelectorAll('#lights input')]"
        self.assertEqual(page.value(f"{summary}.textContent"), "lights: all of 4 on")
        # By keyboard alone.
        page.value(f"{summary}.focus()")
        page.key("Enter")
        page.wait("document.getElementById('lights').open")
        page.value(f"{boxes}.find(b => b.name === 'key').focus()")
        self.changes(lambda: page.key(" "))
        self.assertEqual(page.value(f"{summary}.textContent"), "lights: 3 of 4 on")
        self.shoot("view_lights")
        # Switched-off lights and the focus survive a change of the file.
        self.changes(lambda: self.edit(LIGHTS.replace("radius = 1;", "radius = 0.6;")))
        self.assertEqual(page.value("viewer.controls.lights.off().join()"), "key")
        self.assertEqual(page.value("document.activeElement.name"), "key")
        self.changes(lambda: self.edit(LIGHTS))
        # Environments are offered for renderers of light transport.
        menu = "document.querySelector('[name=environment]')"
        why = f"document.getElementById({menu}.getAttribute('aria-describedby'))"
        self.assertTrue(page.value(f"{menu}.disabled"))
        self.assertIn("those that follow light", page.value(f"{why}.textContent"))
        self.assertGreater(page.value(f"{why}.getBoundingClientRect().height"), 0)
        self.changes(lambda: self.choose("renderer", "path_tracing"))
        self.assertFalse(page.value(f"{menu}.disabled"))
        self.assertFalse(page.value(f"{menu}.hasAttribute('aria-describedby') || document.querySelector('.why') !== null"))
        self.changes(lambda: self.choose("environment", "studio"))
        self.shoot("view_environment")
        off = "[...document.querySelectorAll('#lights button')].find(b => b.textContent === 'All off').click()"
        self.changes(lambda: page.value(off))
        self.assertEqual(page.value(f"{summary}.textContent"), "lights: 0 of 4 on")
        # Undo: lights, environment, renderer, light.
        undo = "[...document.querySelectorAll('button')].find(b => b.textContent === 'Undo').click()"
        for state in ("studio,path_tracing,key", ",path_tracing,key", ",whitted,key", ",whitted,"):
            self.changes(lambda: page.value(undo))
            self.assertEqual(page.value("['environment', 'renderer'].map(k => viewer.controls.get(k)).join() + ',' + "
                                        "viewer.controls.lights.off().join()"), state)
        self.assertEqual(self.picture(), first)
        self.assertEqual(page.value(f"{boxes}.filter(b => b.checked).length"), 4)
        self.check_quiet()

    def test_undo_keeps_a_light_dark_that_was_missing_from_the_file_for_a_while(self):
        self.scene.write_text(LIGHTS, encoding="utf-8")
        self.open(900, 700)
        page = self.page
        dark = "viewer.controls.lights.off().join()"
        page.value("document.getElementById('lights').open = true")
        self.changes(lambda: page.value("document.querySelector('#lights [name=key]').click()"))
        without = LIGHTS.replace('point_light "key"', 'point_light "other"')
        self.changes(lambda: self.edit(without))
        self.assertEqual(page.value(dark), "")
        self.changes(lambda: self.choose("exposure", "1"))
        self.changes(lambda: page.value("viewer.undo()"))
        self.changes(lambda: self.edit(LIGHTS))
        self.assertEqual(page.value(dark), "key")
        self.changes(lambda: page.value("viewer.undo()"))
        self.assertEqual(page.value(dark), "")
        self.check_quiet()

    def test_the_focus_stays_in_the_lights_where_the_file_changes(self):
        self.scene.write_text(LIGHTS, encoding="utf-8")
        self.open(900, 700)
        page = self.page
        page.value("document.getElementById('lights').open = true")
        page.value("document.querySelector('#lights [aria-label=\"Change key\"]').click()")
        key = "document.activeElement.dataset.key"
        for i, place in enumerate(("summary", "on key", "change key", "key position 1", "key times", "All off", "blocks")):
            page.value(f"[...document.querySelectorAll('#lights [data-key]')].find(e => e.dataset.key === '{place}').focus()")
            self.edit(LIGHTS.replace("radius = 1;", f"radius = 0.{i + 2};"))
            self.assertEqual(page.value(key), place)
        # After the removal of a light the focus moves to the list.
        page.value("document.querySelector('#lights [name=key]').focus()")
        self.edit(LIGHTS.replace('point_light "key"', 'point_light "other"'))
        self.assertEqual(page.value(key), "summary")
        self.check_quiet()

    def test_lights_are_moved_and_coloured_and_written_as_blocks(self):
        self.scene.write_text(LIGHTS, encoding="utf-8")
        self.open(1300, 900)
        page = self.page
        first = self.picture()
        page.value("document.getElementById('lights').open = true")

        def field(name):
            return f"[...document.querySelectorAll('#lights [data-key]')].find(e => e.dataset.key === '{name}')"

        def type_in(name, text):
            page.value(f"{field(name)}.focus()")
            page.value(f"{field(name)}.select()")
            page.call("Input.insertText", text=text)

        def button(text):
            return f"[...document.querySelectorAll('button')].find(b => b.textContent === '{text}').click()"

        summary = "document.querySelector('#lights summary').textContent"
        page.value(f"{field('change key')}.click()")
        # Typed values take effect at once; leaving a field unchanged does not.
        self.changes(lambda: type_in("key position 0", "-3"))
        moved = self.picture()
        self.assertEqual(page.value(summary), "lights: all of 4 on, 1 changed")
        self.changes(lambda: type_in("key color 2", "0.25"))
        self.changes(lambda: type_in("key times", "2.5"))
        for text in ("", "-1"):
            type_in("key times", text)
            self.assertEqual(page.value(f"{field('key times')}.getAttribute('aria-invalid')"), "true")
        page.value("document.activeElement.blur()")
        self.assertEqual(page.value(f"{field('key times')}.value + {field('key times')}.getAttribute('aria-invalid')"), "2.5null")
        # A spot light is rotated; a light and a material are dimmed.
        for name in ("spot light 1", "lamp", "ember"):
            page.value(f"{field(f'change {name}')}.click()")
        self.assertIsNone(page.value(f"{field('ember position 0')}?.value ?? null"))
        self.changes(lambda: type_in("spot light 1 direction 0", "1"))
        # The light is a disc: its surface is rebuilt at its new position.
        self.changes(lambda: type_in("lamp position 0", "-1.5"))
        self.changes(lambda: type_in("lamp direction 0", "1"))
        self.changes(lambda: type_in("lamp radius", "0.75"))
        for name, text in (("radius", "0"), ("inner radius", "0.75")):
            type_in(f"lamp {name}", text)
            self.assertEqual(page.value(f"{field(f'lamp {name}')}.getAttribute('aria-invalid')"), "true")
        self.changes(lambda: type_in("lamp times", "0.5"))
        self.changes(lambda: type_in("ember color 0", "0.2"))
        changed = self.picture()
        self.shoot("view_lights_changed")
        # The blocks for the file.
        page.value(button("Light blocks"))
        page.wait("document.getElementById('light-blocks').value.includes('ember')")
        blocks = page.value("document.getElementById('light-blocks').value")
        for part in ('point_light "key"', "position = (-3, 5, 4)", "color = (2.5, 2.5, 0.625)", "spot_light",
                     'disc_light "lamp" { center = (-1.5, 2.4, 0); normal = (1, -1, 0); radius = 0.75; ', "radiance = (1, 1, 0.5)",
                     '// material "ember": emission = (0.2, 0.3, 0.05)'):
            self.assertIn(part, blocks)
        # Edits survive a change of the file and are undone step by step; a field counts once.
        self.changes(lambda: self.edit(LIGHTS.replace("radius = 1;", "radius = 0.6;")))
        self.changes(lambda: self.edit(LIGHTS))
        self.assertEqual(self.picture(), changed)
        for i in range(8):
            self.changes(lambda: page.value("viewer.undo()"))
        self.assertEqual(self.picture(), moved)
        self.changes(lambda: page.value("viewer.undo()"))
        self.assertEqual(self.picture(), first)
        self.assertEqual(page.value(summary), "lights: all of 4 on")
        self.assertEqual(page.value("viewer.controls.lights.changes().length"), 0)
        # A light of another kind with as many sizes has those of the file.
        self.changes(lambda: type_in("lamp radius", "0.75"))
        disc = next(line for line in LIGHTS.split("\n") if line.startswith("disc_light"))
        rectangle = ('rectangle_light "lamp" { corner = (0.8, 2.4, -0.6); edge_u = (1.5, 0, 0); edge_v = (0, 0, 1.25); '
                     'radiance = (2, 2, 1) }')
        self.changes(lambda: self.edit(LIGHTS.replace(disc, rectangle)))
        lamp = "viewer.controls.lights.changes().find(c => c.name === 'lamp')"
        self.assertIsNone(page.value(f"{lamp}.sizes ?? null"))
        self.assertEqual([page.value(f"{field(f'lamp {name}')}.value") for name in ("width", "height")], ["1.5", "1.25"])
        self.changes(lambda: self.edit(LIGHTS))
        self.assertEqual(page.value(f"{field('lamp radius')}.value"), "0.75")
        self.changes(lambda: page.value("viewer.undo()"))
        # The file with the blocks gives the same picture.
        kept = [line for line in LIGHTS.split("\n") if not line.startswith(("spot_light", "disc_light", "point_light"))]
        self.changes(lambda: self.edit("\n".join(kept).replace("emission = (0.9, 0.3, 0.05)", "emission = (0.2, 0.3, 0.05)") + blocks))
        self.assertEqual(self.picture(), changed)
        # As in the file.
        self.changes(lambda: type_in("key times", "0"))
        self.changes(lambda: page.value(f"{field('reset key')}.click()"))
        self.assertEqual(self.picture(), changed)
        self.check_quiet()

    def test_the_picture_stays_in_sight_of_a_phone_while_a_light_is_changed(self):
        self.scene.write_text(LIGHTS, encoding="utf-8")
        self.open(600, 900)
        page = self.page
        # Portrait, with an on-screen keyboard, and landscape.
        for width, height in ((390, 844), (390, 500), (844, 390)):
            page.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=2, mobile=True)
            page.value("scrollTo(0, 0)")
            page.value("document.getElementById('lights').open = true")
            for name in ("key", "lamp", "ember"):
                change = f"document.querySelector('#lights [aria-label=\"Change {name}\"]')"
                if page.value(f"{change}.ariaExpanded") == "false":
                    page.value(f"{change}.click()")
            self.assertLessEqual(page.value("document.documentElement.scrollWidth - innerWidth"), 0)
            for name in ("key position 0", "lamp position 2", "lamp radius", "ember times", "reset ember"):
                picture, field = page.value(f"""(() => {{
                    const field = [...document.querySelectorAll('#lights [data-key]')].find(e => e.dataset.key === '{name}');
                    if (field.disabled) field.scrollIntoView({{block: "nearest"}});
                    else field.focus();
                    return [viewer.image, field].map(e => (b => [b.top, b.bottom, b.height])(e.getBoundingClientRect()));
                }})()""")
                where = (width, height, name, picture, field)
                self.assertGreaterEqual(picture[0], 0, where)
                self.assertGreater(picture[2], 0.3 * height, where)
                self.assertGreaterEqual(field[0], picture[1], where)
                self.assertLessEqual(field[1], height, where)
            self.shoot(f"view_phone_edit_{width}x{height}")
        self.check_quiet()


if __name__ == "__main__":
    run_tests()
