"""What test/mutations finds in a source, and what its list means."""

from source_changes import Unobservable, changes_of, drawn


def shown(text):
    return [change.shown for change in changes_of("a.cpp", text)]


def test_operators_words_steps_and_numbers_are_changed():
    assert shown("  return a + b < 10 && true;\n") == [
        "return a [+ -> -] b < 10 && true;", "return a + b [< -> <=] 10 && true;",
        "return a + b < [10 -> 11] && true;", "return a + b < 10 [&& -> ||] true;",
        "return a + b < 10 && [true -> false];"]
    assert shown("++i;\n") == ["[++ -> --]i;"]
    assert shown("x = 2.0F; y = 0.0; z = 1'000u;\n") == [
        "x = [2.0F -> 2.2F]; y = 0.0; z = 1'000u;", "x = 2.0F; y = [0.0 -> 0.1]; z = 1'000u;",
        "x = 2.0F; y = 0.0; z = [1'000u -> 1001u];"]


def test_operators_at_the_end_of_a_line_are_changed():
    assert shown("a ||\nb\n") == ["a [|| -> &&]"]


def test_what_is_no_code_stays():
    assert not shown('// a + b\n/* 1 < 2\n 3 */ f("a + 1 \\" 2", \'3\');\n#if A > 1\ntemplate <int N = 2>\n'
                     "using A = std::array<int, 3>;\nvector<int> v; int& r; f(-x); m1 = m_2;\n")


def test_the_change_is_made_in_its_place_alone():
    text = "int a = b - c;\nint d = b - c;\n"
    first, second = changes_of("a.cpp", text)
    assert (first.place, second.place) == ("a.cpp:1", "a.cpp:2")
    assert first.applied(text) == "int a = b + c;\nint d = b - c;\n"
    assert second.applied(text) == "int a = b - c;\nint d = b + c;\n"


def test_equal_lines_are_numbered():
    assert shown("return 0;\n}\nreturn 0;\n  return 0;\n") == [
        "return [0 -> 1];", "return [0 -> 1]; (2)", "return [0 -> 1]; (3)"]


def test_the_order_depends_on_the_seed_and_not_on_what_else_is_there():
    text = "".join(f"f(a{letter} + b);\n" for letter in "abcdefgh")
    every = list(changes_of("a.cpp", text))
    order = [change.shown for change in drawn(every, 1)]
    assert sorted(order) == sorted(change.shown for change in every)
    assert order != [change.shown for change in drawn(every, 2)]
    assert [change.shown for change in drawn(reversed(every[2:]), 1)] == [
        text for text in order if text in {change.shown for change in every[2:]}]


def test_the_list_tells_reasons_and_what_it_names_in_vain():
    listed = Unobservable("a.cpp:\n- change: 'a [+ -> -] b'\n  why: b is 0\n- change: 'gone'\n  why: none\n")
    changes = list(changes_of("a.cpp", "a + b\n"))
    assert listed.reason(changes[0]) == "b is 0"
    assert listed.reason(next(changes_of("other.cpp", "a + b\n"))) == ""
    assert listed.unknown(changes) == ["a.cpp: gone"]
    assert Unobservable("# empty\n").unknown(changes) == []
