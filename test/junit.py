"""JUnit files of those checks that are no GoogleTest programs."""

import re
import xml.etree.ElementTree

# Colours of a terminal, for instance.
NOT_IN_XML = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ufffe\uffff]")
MESSAGE_LENGTH = 200


def write(path, suite, cases):
    """Writes results to a file; makes its folder.

    Each case is (name, fault, seconds); the fault is empty where there is none. A fourth value, if it is
    not empty, says why the case was skipped.
    """
    root = xml.etree.ElementTree.Element("testsuite", name=suite, tests=str(len(cases)), errors="0",
                                         failures=str(sum(1 for _, fault, *_ in cases if fault)))
    for name, fault, seconds, *skipped in cases:
        case = xml.etree.ElementTree.SubElement(root, "testcase", classname=suite, name=name, time=f"{seconds:.3f}")
        text = NOT_IN_XML.sub("?", fault)
        if fault:
            message = text.splitlines()[0][:MESSAGE_LENGTH]
            xml.etree.ElementTree.SubElement(case, "failure", message=message).text = text
        elif any(skipped):
            xml.etree.ElementTree.SubElement(case, "skipped", message=skipped[0])
    path.parent.mkdir(parents=True, exist_ok=True)
    xml.etree.ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
