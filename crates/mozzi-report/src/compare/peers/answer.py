def answer(question):
    name = question["library"]
    distribution, module = {"pinocchio": ("pin", "pinocchio"), "mujoco": ("mujoco", "mujoco")}[name]
    result = {"library": name, "version": None, "error": None, "attempts": []}
    try:
        np, library = __import__("numpy"), __import__(module)
    except Exception as error:
        return {**result, "error": {"stage": "import", "message": one_line(error)}}
    try:
        result["version"] = importlib.metadata.version(distribution)
    except importlib.metadata.PackageNotFoundError:
        result["version"] = getattr(library, "__version__", None)
    try:
        if name == "pinocchio":
            robot = Pinocchio(library, np, question)
        else:
            robot = MuJoCo(library, np, question, result["attempts"])
    except Refused as error:
        return {**result, "error": {"stage": "load", "message": str(error)}}
    try:
        result.update(computed(robot, question))
    except Exception as error:
        # a mistake of this script, or what the library raises
        own = isinstance(error, (IndexError, KeyError, TypeError, AttributeError, NameError))
        message = f"{type(error).__name__}: {one_line(error)}"
        fault = "mozzi" if own else "library"
        return {**result, "error": {"stage": "compute", "message": message, "fault": fault}}
    return result


def computed(robot, question):
    joints = [joint for joint in robot.joints() if joint["nv"] > 0]
    base = joints[:1] if question["floating"] and joints and joints[0]["nv"] == 6 else []
    for joint in base:
        joint.update(base=True, called=joint["name"])
    rename(joints[len(base):], question["joints"])
    theirs = {joint["name"]: joint["called"] for joint in joints}
    result = {**robot.about(), "joints": joints, "states": []}
    for state in question["states"]:
        values = [
            {theirs[name]: x for name, x in zip(question["names"], state[key]) if name in theirs}
            for key in ("theta", "dtheta", "ddtheta")
        ]
        result["states"].append(robot.state(*values))
    return result


out.write(json.dumps(answer(json.load(sys.stdin))))
out.flush()
