"""Keys of a US keyboard as the events that Input.dispatchKeyEvent sends to a page."""

NAMED = {  # virtual key code, text that the key writes
    "Backspace": (8, ""),
    "Tab": (9, ""),
    "Enter": (13, "\r"),
    "Escape": (27, ""),
    "Space": (32, " "),
    "PageUp": (33, ""),
    "PageDown": (34, ""),
    "End": (35, ""),
    "Home": (36, ""),
    "ArrowLeft": (37, ""),
    "ArrowUp": (38, ""),
    "ArrowRight": (39, ""),
    "ArrowDown": (40, ""),
    "Delete": (46, ""),
}
# Without and with shift, by virtual key code.
SIGNS = {"`~": 192, "-_": 189, "=+": 187, "[{": 219, "]}": 221, "\\|": 220, ";:": 186, "'\"": 222, ",<": 188, ".>": 190,
         "/?": 191, "1!": 49, "2@": 50, "3#": 51, "4$": 52, "5%": 53, "6^": 54, "7&": 55, "8*": 56, "9(": 57, "0)": 48}
MODIFIERS = {"Alt": 1, "Control": 2, "Shift": 8}


def _sign(character):
    """Returns the virtual key code, and whether shift is held."""
    if character.isalpha():
        return ord(character.upper()), character.isupper()
    for pair, code in SIGNS.items():
        if character in pair:
            return code, character == pair[1]
    raise ValueError(f"no key writes {character!r}")


def events_of(key):
    """Returns the events down, the character if the key writes one, and up: "a", "Enter", "Shift+Tab", "Control+a"."""
    *held, name = key.split("+") if len(key) > 1 else [key]
    modifiers = sum(MODIFIERS[one] for one in held)
    name = "Space" if name == " " else name
    if name in NAMED:
        code, text = NAMED[name]
    else:
        code, is_shifted = _sign(name)
        text = name
        modifiers |= MODIFIERS["Shift"] if is_shifted else 0
    stroke = {"key": " " if name == "Space" else name, "code": name if name in NAMED else "",
              "windowsVirtualKeyCode": code, "modifiers": modifiers}
    down = {**stroke, "type": "rawKeyDown"}
    if key == "Control+a":
        down["commands"] = ["selectAll"]  # the window system's meaning of these keys
    char = [{**stroke, "type": "char", "text": text}] if text and not modifiers & ~MODIFIERS["Shift"] else []
    return [down, *char, {**stroke, "type": "keyUp"}]
