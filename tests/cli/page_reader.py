"""A page as a screen reader presents it: Chromium's accessibility tree, and the order of the Tab key."""

import collections

# Roles of interactive elements; the `summary` of a fold is a DisclosureTriangle.
CONTROLS = {"button", "checkbox", "combobox", "spinbutton", "slider", "textbox", "link", "radio", "DisclosureTriangle",
            "application"}
FIGURES = {"img", "image", "progressbar", "region", "form"}
FIELDS = {"spinbutton", "checkbox", "combobox", "slider", "textbox"}
POINTER = {"click", "dblclick", "mousedown", "mouseup", "pointerdown", "pointerup", "touchstart", "wheel", "contextmenu"}
NO_ROLE = {"", "none", "generic"}


class Node:
    """A node of the tree."""

    def __init__(self, raw):
        self.id, self.children = raw["nodeId"], raw.get("childIds", [])
        self.element = raw.get("backendDOMNodeId")
        self.role, self.name, self.description = (
            str(raw.get(key, {}).get("value", "")).strip() for key in ("role", "name", "description"))
        self.ignored = raw.get("ignored", False)
        self.properties = {p["name"]: p["value"].get("value") for p in raw.get("properties", [])}

    def __repr__(self):
        return f"{self.role} {self.name!r}"


class Reader:
    """A snapshot of the page at construction."""

    def __init__(self, page):
        self.page = page
        page.call("Accessibility.enable")
        page.call("DOM.getDocument")
        all_nodes = [Node(raw) for raw in page.call("Accessibility.getFullAXTree")["nodes"]]
        self.by_id = {node.id: node for node in all_nodes}
        self.nodes = [node for node in all_nodes if not node.ignored]

    def of(self, role, name=""):
        """The nodes of a role whose names begin with a prefix."""
        return [n for n in self.nodes if n.role == role and n.name.startswith(name)]

    def text(self, node):
        """All words in a node."""
        if node.role == "StaticText":
            return node.name
        return " ".join(filter(None, (self.text(self.by_id[c]) for c in node.children if c in self.by_id)))

    def said(self, urgency):
        """The words of the live regions."""
        return "; ".join(filter(None, (self.text(n) for n in self.nodes if n.properties.get("live") == urgency)))

    def below(self, node, role):
        """The nearest nodes of a role below a node."""
        found = []
        for child in (self.by_id[c] for c in node.children if c in self.by_id):
            found += [child] if child.role == role and not child.ignored else self.below(child, role)
        return found

    def controls(self):
        focusable = [n for n in self.nodes if n.properties.get("focusable") and n.role not in ("RootWebArea", "option")]
        return focusable + [n for n in self.nodes if n.role in CONTROLS and n not in focusable]

    def without_role(self):
        return [n for n in self.controls() if n.role in NO_ROLE]

    def without_name(self):
        """Controls without a name and figures without a text."""
        return [n for n in self.controls() if n.role not in NO_ROLE and not any(map(str.isalnum, n.name))] + \
            [n for n in self.nodes if n.role in FIGURES and not n.name]

    def faults(self):
        """Controls without a role or a name, figures without a text, names shared by several fields."""
        found = [f"no role: {n}" for n in self.without_role()] + [f"no name: {n}" for n in self.without_name()]
        count = collections.Counter((n.role, n.name) for n in self.nodes if n.role in FIELDS)
        return found + [f"{k} times: {key}" for key, k in count.items() if k > 1]

    def on(self, element, function):
        """The value of a function of an element."""
        target = self.page.call("DOM.resolveNode", backendNodeId=element)["object"]["objectId"]
        return self.page.call("Runtime.callFunctionOn", objectId=target, functionDeclaration=function,
                              returnByValue=True)["result"].get("value")

    def walk(self, most=900):
        """Presses Tab until the focus returns to its start; returns the number of presses."""
        page = self.page
        page.value("globalThis.tabbed = new Set(); document.body.tabIndex = -1; document.body.focus(); "
                   "document.body.removeAttribute('tabindex')")
        for i in range(most):
            page.key("Tab")
            if page.value("(e => e === document.body || e === null || tabbed.has(e) || !tabbed.add(e))(document.activeElement)"):
                return i
        raise AssertionError(f"the Tab key has not come around after {most} times")

    def not_reached(self):
        """Controls that Tab does not reach, except disabled ones and those focused by scripts only."""
        self.walk()
        controls = [n for n in self.controls() if not n.properties.get("disabled")]
        return [n for n in controls if not self.on(n.element, "function() { return tabbed.has(this); }") and
                (n.role in CONTROLS or self.on(n.element, "function() { return this.tabIndex; }") >= 0)]

    def mouse_only(self):
        """Elements with mouse listeners that cannot have the focus."""
        document = self.page.call("Runtime.evaluate", expression="document")["result"]["objectId"]
        heard = self.page.call("DOMDebugger.getEventListeners", objectId=document, depth=-1)["listeners"]
        named = {n.element for n in self.controls() if n.name}
        elements = {e["backendNodeId"] for e in heard if e["type"] in POINTER} - named
        return [self.page.call("DOM.describeNode", backendNodeId=e)["node"]["nodeName"] for e in elements
                if self.on(e, "function() { return this.checkVisibility?.() !== false && !this.disabled; }")]
