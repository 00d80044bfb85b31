:- module(test_old_settings, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(settings)).
:- use_module(library(typhon)).

% A program for an earlier version sets a setting by its old name.

:- begin_tests(old_settings).

test(old_name_sets_the_new_one,
     [ forall(typhon_old_settings:renamed(Old, New)),
       Value-Messages == Other-[warning-typhon(setting_renamed(Old, New))] ]) :-
    setting_property(New, default(Default)),
    setting_property(New, type(Type)),
    other(Type, Default, Other),
    call_cleanup(
        ( capturing(set_setting(Old, Other), Messages),
          setting(New, Value) ),
        capturing(restore_setting(Old), _)).
test(value_of_an_old_name_is_checked, error(type_error(_, many))) :-
    set_setting(typhon_keeper:resting, many).
test(old_names_are_not_listed, Old == []) :-
    findall(Name, ( current_setting(Name),
                    typhon_old_settings:renamed(Name, _) ), Old).

:- end_tests(old_settings).

other(boolean, Default, Other) :-
    !,
    ( Default == true -> Other = false ; Other = true ).
other(_, Default, Other) :-
    integer(Default),
    !,
    Other is Default+1.
other(_, Default, Other) :-
    float(Default),
    !,
    Other is Default/2.
other(_, _, other).
