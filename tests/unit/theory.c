#include "core/schemes.h"
#include "core/theory/theory.h"
#include <stdio.h>
int main(void){ for(size_t i=0;i<gm_scheme_count();i++){const struct gm_scheme*s=gm_scheme_at(i); if(!s->family->coefficients_open)continue; struct gm_coefficients c; s->family->coefficients_open(s,&c); struct gm_theory t=gm_theory_of(&c);
 printf("%-26s claims %d: order %d%s conds %d fail %d/%d %s %.3e E %.4g sympl %d sym %d pseudo %d BCD %d %d %d real %.15g imag %.15g A%d L%d %s\n",s->name,s->order,t.order,t.at_least?"+":"",t.conditions,t.failing,t.of,t.condition,t.residual,t.error_constant,t.symplectic,t.symmetric,t.pseudo_symplectic,t.b,t.c,t.d,t.stability.real,t.stability.imaginary,t.stability.a_stable,t.stability.l_stable,
 (t.order!=s->order|| t.symplectic!=!!(s->claims&GM_SYMPLECTIC)||t.symmetric!=!!(s->claims&GM_SYMMETRIC))?"<<<<":"");gm_coefficients_close(&c);} }
