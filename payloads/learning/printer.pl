/*  Printers: their properties, and the quality of a page. Included in the problem
    of learning agents, and in the sieve.

    Facts setting(Name, Value) of the agent replace the values of about/2; they
    are explained in settings.pl.
*/

about(noise, 0.04).
about(good, 0.93).
about(pages, 4).
about(difference, 1.0).
about(printers, 1).

known(Name, Value) :-
    (   setting(Name, Value0)
    ->  Value = Value0
    ;   about(Name, Value)
    ).

%   The properties of a printer, makes(Density, Heat, Wear): the deviation of
%   its best density and heat from those of others, and a loss of quality that
%   no setting compensates.

printer(Name) :-
    here(Host),
    atomic_list_concat([Name|_], @, Host).

makes(Printer, makes(Density, Heat, Wear)) :-
    known(printers, Which),
    known(difference, Far),
    typhon_prng:chance_hash(Which-Printer, Seed),
    typhon_prng:chance_seed(Seed, Chance0),
    Near is -Far,
    typhon_prng:chance_uniform(Near, Far, Density, Chance0, Chance1),
    typhon_prng:chance_uniform(Near, Far, Heat, Chance1, Chance2),
    typhon_prng:chance_uniform(0.0, 0.03, Wear, Chance2, _).

%   Thick paper and high speed need heat, and pictures need toner: one
%   setting alone often cannot be improved.

quality(Printer, [Resolution,Mode,Paper,Density,Heat,Speed], Quality) :-
    makes(Printer, makes(MoreDensity, MoreHeat, Wear)),
    coarse(Resolution, Loss1),
    rough(Mode, Wanted, Loss2),
    dull(Paper, Warm, Loss3),
    Loss4 is 0.02*(Density - Wanted - MoreDensity)**2,
    Loss5 is 0.015*(Heat - Warm - 0.5*(Speed - 3) - MoreHeat)**2,
    Loss6 is 0.02*(Speed - 1),
    Quality is max(0.0, 1 - Wear - Loss1 - Loss2 - Loss3 - Loss4 - Loss5
                        - Loss6).

coarse(1, 0.15).
coarse(2, 0.07).
coarse(3, 0.0).
coarse(4, 0.02).

rough(draft, 5, 0.25).
rough(text,  4, 0.12).
rough(photo, 6, 0.0).

dull(thin,   2, 0.14).
dull(plain,  3, 0.09).
dull(thick,  5, 0.05).
dull(glossy, 6, 0.0).
